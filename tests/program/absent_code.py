#!/usr/bin/python3
"""absent_code.py NATIVE_FRAME VALGRIND ISA FOLDER: what a scene does not need is not executed.

Renders small scenes under callgrind, which lists every function that ran, and compares the features whose functions did
with those that each scene has. Each is in one of them at least, so that no function is looked for that has another name by
now. Exit code 1 where they differ.
"""
import re
import struct
import subprocess
import sys
import zlib
from pathlib import Path

# Features and what only their functions are called.
FEATURES = {
    "normals or texture coordinates on vertices": r"::make_normals\(",
    "blending between levels": r"::blend_block\(",
    "rectangle lights": r"gather_light<.*TowardsRectangle",
    "other lights": r"gather_light<.*TowardsShape",
    "constant sky": r"gather_light<.*TowardsSky,",
    "mapped sky": r"gather_light<.*TowardsMappedSky|::see_mapped_sky\(|::sample_sky_direction\(",
    "textures": r"::sample_map<false>\(",
    "patterns": r"::sample_pattern\(",
    "textures at vertices of grids": r"::shade_vertices\(",
    "displacement": r"::place_displaced\(|::make_displaced_normals\(|::displaced_point\(",
    "sheen": r"\bCloth\b",
    "maps of sheen": r"::weave\(|::mapped_sheen(_roughness)?\(|::shade_sheen\(|::find_shaded_sheen\(|\bTwoRows\b|::sheen_albedos\(|::sheen_roughness_range\(",
    "surfaces that are lights": r"::sample_emitters\(|TowardsEmitters",
    "lights that are chosen": r"TowardsChosen|::sample_chosen\(|::meet_chosen\(",
    "opacity of textures": r"::sample_map<true>\(|::find_holes\(",
    "paths": r"::sample_bounce[(<]",
    "lights met by bounces": r"::meet_lights\(",
    "shading by materials' records": r"MatteSampler<true>|PathSampler<",
}
RECTANGLE = "[[light]]\ncorner = [-1, 4, -1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, 2]\nradiance = 9\n"
POINT = '[[light]]\nkind = "point"\nposition = [1, 5, 2]\nintensity = 40\n'
TEXTURE = '[[texture]]\nname = "t"\nfile = "t.png"\n'
OBJ = '[[mesh]]\nfile = "quad.obj"\nscheme = "bilinear"\nedge_length = 9\nmaterial = "m"\n'
SMOOTH = '[[mesh]]\nname = "smooth"\nshape = "box"\nscale = 0.5\ntranslate = [0, 0, -2]\nmaterial = "matte"\n'
MATTE = '[[material]]\nname = "m"\nalbedo = 0.5\n'
METAL = '[[material]]\nname = "m"\nmetallic = 1\nroughness = 0.4\n'
MAPPED = TEXTURE + '[[material]]\nname = "m"\nalbedo_map = "t"\n'
PATTERN = '[[texture]]\nname = "p"\npattern = "noise"\n[[material]]\nname = "m"\nalbedo_map = "p"\n'
CLOTH = '[[material]]\nname = "m"\nsheen = 0.5\n'
VELVET = TEXTURE + '[[material]]\nname = "m"\nalbedo_map = "t"\nsheen_map = "t"\nsheen_roughness_map = "t"\n'
LAMP = '[[material]]\nname = "m"\nemission = 4\nlight = true\n'
BUMPY = TEXTURE + '[[material]]\nname = "m"\nalbedo = 0.5\ndisplacement_map = "t"\ndisplacement_scale = 0.1\n'
PLAIN = '[[material]]\nname = "matte"\nalbedo = 0.5\n'
CUT = TEXTURE + '[[material]]\nname = "m"\nmetallic = 1\nroughness = 0.4\nalbedo_map = "t"\nalpha_cutoff = 0.45\n'
DARK, CONSTANT, SKY_MAP = "[sky]\nradiance = 0\n", "[sky]\nradiance = 0.5\n", '[sky]\nmap = "t"\n'
SURFACES = {"normals or texture coordinates on vertices", "blending between levels"}

# Name, scene, features that it has.
SCENES = [
    ("a matte square under a lamp", DARK + RECTANGLE + MATTE + OBJ, {"rectangle lights"}),
    ("smooth, under a constant sky", CONSTANT + PLAIN + SMOOTH, SURFACES | {"constant sky"}),
    ("metal, a point of light", DARK + POINT + METAL + OBJ,
     {"other lights", "paths", "lights met by bounces", "shading by materials' records"}),
    ("one ray to many lights", DARK + POINT * 13 + MATTE + OBJ, {"lights that are chosen"}),
    ("textured", DARK + RECTANGLE + MAPPED + OBJ,
     {"rectangle lights", "normals or texture coordinates on vertices", "textures", "shading by materials' records"}),
    ("a smooth pattern", DARK + RECTANGLE + PATTERN + SMOOTH.replace('"matte"', '"m"'),
     SURFACES | {"rectangle lights", "patterns", "textures", "textures at vertices of grids", "shading by materials' records"}),
    ("cloth", DARK + RECTANGLE + CLOTH + OBJ,
     {"rectangle lights", "sheen", "paths", "shading by materials' records"}),
    ("cloth beside a texture", DARK + RECTANGLE + CLOTH.replace("sheen", 'albedo_map = "t"\nsheen') + TEXTURE + OBJ,
     {"rectangle lights", "sheen", "paths", "normals or texture coordinates on vertices", "textures",
      "shading by materials' records"}),
    ("velvet", DARK + RECTANGLE + VELVET + SMOOTH.replace('"matte"', '"m"'),
     SURFACES | {"rectangle lights", "sheen", "maps of sheen", "paths", "textures", "textures at vertices of grids",
                 "shading by materials' records"}),
    ("a lamp", DARK + LAMP + PLAIN + OBJ + SMOOTH,
     SURFACES | {"surfaces that are lights", "paths", "shading by materials' records"}),
    ("displaced", DARK + RECTANGLE + BUMPY + OBJ,
     {"normals or texture coordinates on vertices", "rectangle lights", "displacement"}),
    ("under a mapped sky", SKY_MAP + TEXTURE + MATTE + OBJ, {"mapped sky", "textures", "shading by materials' records"}),
    ("everything but a map of the sky", CONSTANT + RECTANGLE + POINT + CUT + PLAIN + OBJ + SMOOTH,
     set(FEATURES) - {"mapped sky", "patterns", "textures at vertices of grids", "displacement", "sheen", "maps of sheen", "surfaces that are lights",
                      "lights that are chosen"}),
]


def png(width, height, rgba):
    rows = b"".join(b"\0" + rgba[y * width * 4:(y + 1) * width * 4] for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def executed(program, valgrind, isa, folder, text):
    """Names of all functions that ran."""
    (folder / "scene.toml").write_text("[settings]\nsize = [12, 12]\nsamples = 1\nlight_samples = 1\nsky_samples = 1\n"
                                       "bounces = 1\nlight_choices = 1\n[camera]\nposition = [1, 2, 4]\ntarget = [0, 0, 0]\n" + text)
    out = folder / "callgrind.out"
    subprocess.run([valgrind, "--tool=callgrind", f"--callgrind-out-file={out}", program, "scene.toml", "--isa", isa,
                    "--arena", "16"], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    names, ran = {}, set()
    for line in out.read_text().splitlines():
        match = re.match(r"c?fn=\((\d+)\)(?: (.*))?", line)
        if match:
            if match[2]:
                names[match[1]] = match[2]
            ran.add(match[1])
    return {names[number] for number in ran}


def main():
    program, valgrind, isa, folder = sys.argv[1:5]
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "t.png").write_bytes(png(4, 4, bytes((90 + i) % 256 for i in range(4 * 4 * 4))))
    (folder / "quad.obj").write_text("v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                     "f 1/1 2/2 3/3 4/4\n")
    wrong = 0
    for name, text, expected in SCENES:
        functions = executed(program, valgrind, isa, folder, text)
        found = {feature for feature, pattern in FEATURES.items() if any(re.search(pattern, f) for f in functions)}
        for what, features in (("ran", found - expected), ("did not run", expected - found)):
            for feature in sorted(features):
                wrong = 1
                print(f"{name}: the code of {feature} {what}")
        print(f"{name}: {len(found)} of {len(FEATURES)} features, {len(functions)} functions")
    return wrong


if __name__ == "__main__":
    sys.exit(main())
