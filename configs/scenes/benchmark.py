#!/usr/bin/python3
"""Writes the four benchmark scenes beside itself: courtyard, interior, forest and showcase (.toml), all animated; the
same with patterns and bumps on most surfaces (-textured.toml); and the showcase with displaced and mirroring ones
(showcase-displaced.toml), whose height maps are heights-*.png.

    configs/scenes/benchmark.py            # writes them
    configs/scenes/benchmark.py --check    # says which of them are not what it would write

They stand in for the kinds of scenes that ray tracers are measured by: many walking figures in a walled court, a building
of which one room is seen, a forest, smooth creased shapes. All is made of shapes that Razor makes by itself. Lengths are
metres, times seconds.
"""
import itertools
import math
import os
import random
import struct
import sys
import zlib


class Scene:
    """Text of a scene file, table by table."""

    def __init__(self, name, about, scheme, variant):
        self.scheme = scheme
        self.variant = variant
        if variant:
            name = f"{name}-{variant}"
            about = about + [{"textured": "With patterns and bumps.", "displaced": "Displaced, or mirrors."}[variant]]
        self.text = [f"# {line}" for line in about] + [f'name = "{name}"']

    def table(self, header, **values):
        self.text.append(f"\n{header}" if header != "[mesh.parameters]" else header)
        for key, value in values.items():
            self.text.append(f"{key} = {number(value)}")

    def mesh(self, name, shape, material, parameters=None, deform=(), scheme=None, **values):
        self.table("[[mesh]]", name=name, shape=shape, scheme=scheme or self.scheme, material=material, **values)
        if parameters:
            self.table("[mesh.parameters]", **parameters)
        for d in deform:
            self.keys("[[mesh.deform]]", **d)

    def keys(self, header, **values):
        self.text.append(header)
        self.text += [f"{key} = {number(value)}" for key, value in values.items()]

    def group(self, name, *objects):
        self.table("[[group]]", name=name)
        for thing in objects:
            self.object(thing, "group.object")

    def object(self, thing, header="object"):
        """thing: a dict of values; `keys`: a list of dicts."""
        keys = thing.pop("keys", [])
        self.table(f"[[{header}]]", **thing)
        for key in keys:
            self.keys(f"[[{header}.key]]", **key)

    def write(self):
        return "\n".join(self.text) + "\n"


def number(value):
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(number(x) for x in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {number(x)}" for key, x in value.items()) + " }"
    if isinstance(value, int):
        return str(value)
    return f"{round(value, 4) + 0.0:g}"


def at(kind, name, translate, **more):
    return {kind: name, "translate": translate, **more}


# --- figures

def swing(amplitude, cycle, phase, offset=0.0, steps=8):
    """Keys of a turn about x that swings like a pendulum; phase in turns."""
    return {"interpolation": "smooth", "cycle": cycle,
            "keys": [{"time": cycle * k / steps,
                      "rotate": [offset + amplitude * math.sin(2 * math.pi * (k / steps + phase)), 0.0, 0.0]}
                     for k in range(steps)]}


def figure_meshes(scene, skin, cloth):
    around = {"segments": 16}
    for name, material, rings, length, joint, end in (
            ("torso", cloth, 4, 0.46, 0.19, 0.15), ("neck", skin, 1, 0.12, 0.05, 0.06), ("head", skin, 2, 0.10, 0.12, 0.10),
            ("upper_arm", cloth, 3, 0.28, 0.065, 0.05), ("lower_arm", skin, 3, 0.26, 0.048, 0.038),
            ("upper_leg", cloth, 3, 0.42, 0.095, 0.07), ("lower_leg", cloth, 3, 0.40, 0.068, 0.045)):
        scene.mesh(name, "limb", material, {**around, "rings": rings, "length": length, "joint": joint, "end": end})
    scene.mesh("foot", "box", skin, {"width": 0.1, "height": 0.07, "depth": 0.26, "sharpness": 1.0})


def figure(scene, name, cycle, phase, stride=28.0):
    """A walking figure, 1.8 m tall, that looks along z; `stride`: degrees its legs swing."""
    for side, turn in (("left", phase), ("right", phase + 0.5)):
        scene.group(f"{name}_shin_{side}", at("mesh", "lower_leg", [0.0, 0.0, 0.0]),
                    at("mesh", "foot", [0.0, -0.41, 0.06]))
        scene.group(f"{name}_leg_{side}", at("mesh", "upper_leg", [0.0, 0.0, 0.0]),
                    at("group", f"{name}_shin_{side}", [0.0, -0.42, 0.0],
                       **swing(0.6 * stride, cycle, turn + 0.3, 0.65 * stride)))
        scene.group(f"{name}_arm_{side}", at("mesh", "upper_arm", [0.0, 0.0, 0.0]),
                    at("mesh", "lower_arm", [0.0, -0.28, 0.0], rotate=[-25.0, 0.0, 0.0]))
    scene.group(name, at("mesh", "torso", [0.0, 1.40, 0.0]), at("mesh", "neck", [0.0, 1.60, 0.0]),
                at("mesh", "head", [0.0, 1.72, 0.02]),
                *(at("group", f"{name}_leg_{side}", [x, 0.88, 0.0], **swing(stride, cycle, turn))
                  for side, x, turn in (("left", 0.10, phase), ("right", -0.10, phase + 0.5))),
                *(at("group", f"{name}_arm_{side}", [x, 1.42, 0.0], **swing(0.8 * stride, cycle, turn))
                  for side, x, turn in (("left", 0.25, phase + 0.5), ("right", -0.25, phase))))


# --- the scenes

def facing(way, centre, across, up, radiance):
    """A rectangle light about `centre` that looks along `way` (whole numbers, so that its edges are exact). Its level
    edges are as long as the level part of `way`, times `across`; the others are in proportion to `up`."""
    level = [way[2], 0, -way[0]]
    edge_u = [across * x for x in level]
    edge_v = [up * x for x in (way[1] * level[2], way[2] * level[0] - way[0] * level[2], -way[1] * level[0])]
    return {"corner": [c - (a + b) / 2 for c, a, b in zip(centre, edge_u, edge_v)], "edge_u": edge_u, "edge_v": edge_v,
            "radiance": radiance}


# Of materials: the pattern, how much darker and brighter than the material it gets, how high it is, and what else it is.
PATTERNS = {
    "paving": ("noise", 0.5, 0.02, {"size": 0.3}), "wall": ("bricks", 0.35, 0.03, {"size": 0.6, "amount": 0.06}),
    "stone": ("turbulence", 0.4, 0.02, {"size": 0.25}), "cloth": ("checker", 0.5, 0.0, {"size": 0.06}),
    "linen": ("noise", 0.25, 0.0, {"size": 0.05, "octaves": 3}), "rust": ("noise", 0.6, 0.0, {"size": 0.12}),
    "plaster": ("noise", 0.12, 0.01, {"size": 0.4}), "floor": ("wood", 0.35, 0.0, {"size": 0.08, "amount": 0.6}),
    "wood": ("wood", 0.4, 0.0, {"size": 0.05, "amount": 0.8}), "carpet": ("checker", 0.3, 0.0, {"size": 0.2}),
    "soil": ("noise", 0.7, 0.1, {"size": 0.6}), "bark": ("turbulence", 0.6, 0.03, {"size": 0.12}),
    "needles": ("noise", 0.5, 0.0, {"size": 0.3, "octaves": 3}), "leaves": ("noise", 0.5, 0.0, {"size": 0.2, "octaves": 3}),
    "grass": ("noise", 0.5, 0.0, {"size": 0.1, "octaves": 3}), "fur": ("turbulence", 0.6, 0.0, {"size": 0.1}),
    "marble": ("marble", 0.4, 0.0, {"size": 0.5, "amount": 2.5}), "jade": ("marble", 0.5, 0.0, {"size": 0.6, "amount": 1.5}),
    "copper": ("noise", 0.5, 0.03, {"size": 0.15}), "ivory": ("wood", 0.15, 0.0, {"size": 0.1, "amount": 1.0}),
    "ink": ("turbulence", 0.8, 0.05, {"size": 0.25}), "saffron": ("noise", 0.4, 0.04, {"size": 0.12}),
    "rose": ("turbulence", 0.5, 0.0, {"size": 0.2}), "hall": ("checker", 0.2, 0.0, {"size": 1.0}),
}


def periodic(cosines):
    """Of (columns, rows, phase in turns, weight): their sum over a texture, at (u, v)."""
    return lambda u, v: sum(weight * math.cos(2 * math.pi * (columns * u + rows * v + phase))
                            for columns, rows, phase, weight in cosines)


def rough():
    """Noise: cosines of random directions and phases, whose weights fall with their frequencies."""
    chance = random.Random(3)
    waves = [(a, b) for a in range(0, 13) for b in range(-12, 13) if (a > 0 or b > 0) and 3 <= math.hypot(a, b) <= 12]
    return periodic([(a, b, chance.random(), math.hypot(a, b) ** -1.6) for a, b in chance.sample(waves, 48)])


def scale(u, v):
    """Two rows of scales, each of which rises from its upper end to its round lower one and covers what is below."""
    heights = [0.0]
    for row in range(-1, 3):
        for column in range(-1, 2):
            x, y = (u - column - 0.5 * (row % 2) - 0.25) / 0.5, (v - 0.5 * row) / 0.75
            inside = 1 - x * x - max(0.0, 0.45 - y) ** 2 / 0.2
            if inside > 0 and 0 <= y < 1:
                heights.append(min(1.0, 5 * inside) * (1 - 0.8 * y) * (1 - 0.35 * x * x) * min(1.0, (1 - y) / 0.2))
    return max(heights)


def ripple(u, v):
    """Rings about the middle that fade towards the edge."""
    r = math.hypot(u - 0.5, v - 0.5) / 0.5
    return math.cos(2 * math.pi * 6 * r) * max(0.0, 1 - r * r)


# Height maps: columns, rows, and heights at (u, v), of which the least and the largest become 0 and 65535.
HEIGHTS = {"rough": (128, 128, rough()), "scales": (96, 96, scale), "ripples": (192, 192, ripple),
           "dimples": (48, 48, lambda u, v: -max(0.0, 1 - math.hypot(u - 0.5, v - 0.5) ** 2 / 0.2) ** 2),
           "ribs": (64, 4, lambda u, v: abs(math.cos(math.pi * u)) ** 0.7)}
# Of materials: heights, how high (in the mesh's own unit, from the lowest to the highest), how often the map repeats.
DISPLACED = {"jade": ("scales", 0.07, [36, 4]), "ivory": ("rough", 0.09, [2, 2]), "ink": ("dimples", 0.05, [24, 12]),
             "rose": ("ribs", 0.06, [18, 1]), "cream": ("ripples", 0.16, [1, 1]), "marble": ("rough", 0.025, [1, 1])}
# Polished metals: what they reflect.
MIRRORS = {"copper": [0.95, 0.64, 0.54], "saffron": [1.0, 0.78, 0.34], "chrome": [0.77, 0.78, 0.78]}


def displaced_materials(scene, materials):
    for name in sorted({heights for heights, _, _ in DISPLACED.values()}):
        scene.table("[[texture]]", name=name, file=f"heights-{name}.png", color_space="linear")
    for name, albedo in materials.items():
        if name in MIRRORS:
            scene.table("[[material]]", name=name, kind="principled", albedo=MIRRORS[name], metallic=1, roughness=0)
        elif name in DISPLACED:
            heights, height, repeat = DISPLACED[name]
            scene.table("[[material]]", name=name, kind="principled", albedo=albedo, roughness=0.35,
                        displacement_map={"texture": heights, "scale": repeat}, displacement_scale=height)
        else:
            scene.table("[[material]]", name=name, albedo=albedo)


def height_map(columns, rows, height):
    """A PNG of 16 bits a texel, as bytes; v upwards."""
    values = [[height((x + 0.5) / columns, 1 - (y + 0.5) / rows) for x in range(columns)] for y in range(rows)]
    least, most = min(map(min, values)), max(map(max, values))
    rows_of_bytes = b"".join(b"\0" + struct.pack(f">{columns}H", *(round(65535 * (h - least) / (most - least)) for h in row))
                             for row in values)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", columns, rows, 16, 0, 0, 0, 0)) + \
        chunk(b"IDAT", zlib.compress(rows_of_bytes, 9)) + chunk(b"IEND", b"")


def head(scene, camera, lights, background, materials, size=(1024, 1024)):
    """A frame takes 36 rays a pixel where nothing faces away: 4 samples, each with 4 to each of two lights."""
    scene.table("[settings]", size=list(size), samples=4, light_samples=4, sky_samples=0)
    scene.table("[animation]", rate=24)
    scene.table("[camera]", **camera)
    scene.table("[sky]", radiance=background)
    for light in lights:
        scene.table("[[light]]", **light)
    if scene.variant == "displaced":
        displaced_materials(scene, materials)
        return
    patterns = {name: PATTERNS[name] for name in materials if name in PATTERNS and scene.variant == "textured"}
    for name, (pattern, depth, bump, values) in patterns.items():
        albedo = materials[name]
        scene.table("[[texture]]", name=name, pattern=pattern, low=[round(x * (1 - depth), 3) for x in albedo],
                    high=[round(min(x * (1 + depth), 1), 3) for x in albedo], **values)
    for name, albedo in materials.items():
        if name not in patterns:
            scene.table("[[material]]", name=name, albedo=albedo)
        elif patterns[name][2] == 0:
            scene.table("[[material]]", name=name, albedo_map=name)
        else:
            scene.table("[[material]]", name=name, albedo_map=name, bump_map=name, bump=patterns[name][2])


def courtyard(variant=None):
    scene = Scene("courtyard", ["64 figures walk in a walled court. Written by benchmark.py."], "bilinear", variant)
    head(scene, {"position": [10.6, 4.3, 11.0], "target": [0.0, 0.3, 0.0], "fov": 54},
         [{"corner": [-26.0, 30.0, 8.0], "edge_u": [6.0, 6.0, 0.0], "edge_v": [-3.5355, 3.5355, 6.0], "radiance": [190, 170, 140]},
          facing([-3, -6, -4], [14.0, 30.0, 18.0], 8.0, 1.0, [1.0, 1.15, 1.35])],
         [0.42, 0.48, 0.56],
         {"paving": [0.52, 0.49, 0.44], "wall": [0.66, 0.58, 0.47], "stone": [0.58, 0.56, 0.52], "skin": [0.62, 0.42, 0.31],
          "cloth": [0.30, 0.22, 0.42], "linen": [0.70, 0.66, 0.58], "rust": [0.52, 0.20, 0.12], "water": [0.18, 0.30, 0.34]})
    scene.mesh("ground", "plane", "paving", {"width": 60.0, "depth": 60.0}, translate=[0.0, -0.06, 0.0])
    scene.mesh("slab", "box", "paving", {"width": 0.97, "height": 0.1, "depth": 0.97, "sharpness": 0.0})
    scene.mesh("wall", "box", "wall", {"width": 28.0, "height": 5.0, "depth": 0.9})
    scene.mesh("merlon", "box", "wall", {"width": 0.9, "height": 0.8, "depth": 0.9})
    scene.mesh("column", "limb", "stone", {"segments": 24, "rings": 6, "length": 3.2, "joint": 0.26, "end": 0.32})
    scene.mesh("foot_stone", "box", "stone", {"width": 0.9, "height": 0.4, "depth": 0.9})
    scene.mesh("beam", "box", "stone", {"width": 24.0, "height": 0.35, "depth": 0.7})
    scene.mesh("basin", "bowl", "stone", {"segments": 48}, scale=2.0)
    scene.mesh("pool", "plane", "water", {"width": 2.6, "depth": 2.6, "columns": 48, "rows": 48}, deform=[
        {"kind": "wave", "axis": [1, 0, 0.4], "direction": [0, 1, 0], "amount": 0.012, "wavelength": 0.5, "period": 0.9},
        {"kind": "wave", "axis": [-0.3, 0, 1], "direction": [0, 1, 0], "amount": 0.010, "wavelength": 0.37, "period": 0.7}])
    figure_meshes(scene, "skin", "cloth")
    steps = 4
    for phase in range(steps):
        figure(scene, f"walker_{phase}", 1.1, phase / steps)
    scene.group("arcade", at("mesh", "beam", [0.0, 3.75, 0.0]),
                at("mesh", "column", [-11.5, 3.4, 0.0], array=[8, 1, 1], spacing=[3.2857, 0.0, 0.0]),
                at("mesh", "foot_stone", [-11.5, 0.0, 0.0], array=[8, 1, 1], spacing=[3.2857, 0.0, 0.0]))
    scene.group("side", at("mesh", "wall", [0.0, 2.5, -14.0]),
                at("mesh", "merlon", [-13.5, 5.4, -14.0], array=[16, 1, 1], spacing=[1.8, 0.0, 0.0]),
                at("group", "arcade", [0.0, 0.0, -11.8]))
    for quarter in range(4):
        scene.object(at("group", "side", [0.0, 0.0, 0.0], rotate=[0.0, 90.0 * quarter, 0.0]))
    scene.object(at("mesh", "slab", [-12.5, -0.05, -12.5], array=[26, 1, 26], spacing=[1.0, 0.0, 1.0]))
    scene.object(at("mesh", "basin", [0.0, 0.0, 0.0]))
    scene.object(at("mesh", "pool", [0.0, 1.75, 0.0]))
    chance = random.Random(7)
    cloths = ["cloth", "linen", "rust", "stone"]
    for row in range(8): # four walkers twice, the second between the first
        x = -9.1 + 2.6 * row
        way = 1 if row % 2 == 0 else -1
        for half in range(2):
            z = way * (-9.5 + 2.4 * half + chance.uniform(-0.3, 0.3))
            scene.object(at("group", f"walker_{(row + 2 * half) % steps}", [x + chance.uniform(-0.35, 0.35), 0.0, z],
                            rotate=[0.0, 0.0 if way > 0 else 180.0, 0.0], material=cloths[(row + half) % 4],
                            array=[1, 1, 4], spacing=[0.0, 0.0, 4.8 * way],
                            keys=[{"time": 0, "translate": [x, 0.0, z]},
                                  {"time": 8, "translate": [x, 0.0, z + way * 8 * 1.15]}]))
    return scene


def interior(variant=None):
    scene = Scene("interior", ["A house of twenty rooms with two people in each; the camera is in one room. Written by benchmark.py."],
                  "bilinear", variant)
    head(scene, {"position": [14.7, 1.8, 9.7], "target": [11.4, 0.95, 6.2], "fov": 64},
         [{"corner": [13.9, 2.93, 6.7], "edge_u": [0.0, 0.0, 1.6], "edge_v": [-2.4, 0.0, 0.0], "radiance": [8.5, 7.8, 6.6]},
          {"corner": [14.8, 0.9, 9.88], "edge_u": [-4.6, 0.0, 0.0], "edge_v": [0.0, 1.9, 0.0], "radiance": [1.7, 1.9, 2.2]}],
         [0.55, 0.60, 0.68],
         {"plaster": [0.74, 0.70, 0.63], "wood": [0.40, 0.25, 0.14], "floor": [0.46, 0.36, 0.27], "brass": [0.58, 0.44, 0.20],
          "clay": [0.55, 0.28, 0.18], "skin": [0.62, 0.42, 0.31], "cloth": [0.20, 0.30, 0.40], "books": [0.36, 0.16, 0.14]})
    rooms_x, rooms_z, side, height = 5, 4, 5.0, 3.0
    wide, deep = rooms_x * side, rooms_z * side
    scene.mesh("floor", "box", "floor", {"width": wide + 0.2, "height": 0.2, "depth": deep + 0.2, "sharpness": 0.0},
               translate=[wide / 2, -0.1, deep / 2])
    scene.mesh("ceiling", "box", "plaster", {"width": wide + 0.2, "height": 0.2, "depth": deep + 0.2, "sharpness": 0.0},
               translate=[wide / 2, height + 0.1, deep / 2])
    scene.mesh("lawn", "plane", "floor", {"width": 400.0, "depth": 400.0}, translate=[0.0, -0.3, 0.0])
    scene.mesh("pier", "box", "plaster", {"width": 2.0, "height": height, "depth": 0.2, "sharpness": 0.0})
    scene.mesh("lintel", "box", "plaster", {"width": 1.0, "height": 0.8, "depth": 0.2, "sharpness": 0.0})
    scene.mesh("top", "box", "wood", {"width": 1.5, "height": 0.06, "depth": 0.9})
    scene.mesh("leg", "limb", "wood", {"segments": 12, "rings": 3, "length": 0.66, "joint": 0.045, "end": 0.03})
    scene.mesh("seat", "box", "wood", {"width": 0.44, "height": 0.05, "depth": 0.44})
    scene.mesh("back", "box", "wood", {"width": 0.44, "height": 0.5, "depth": 0.04})
    scene.mesh("board", "box", "wood", {"width": 1.6, "height": 0.04, "depth": 0.3})
    scene.mesh("book", "box", "books", {"width": 0.05, "height": 0.24, "depth": 0.18})
    scene.mesh("vase", "bowl", "clay", {"segments": 40}, scale=0.17)
    scene.mesh("wheel", "gear", "brass", {"teeth": 17, "thickness": 0.12}, rotate=[90, 0, 0], scale=0.34)
    figure_meshes(scene, "skin", "cloth")
    figure(scene, "idle_0", 3.2, 0.0, 4.0)
    figure(scene, "idle_1", 4.1, 0.4, 3.0)
    scene.group("wall", at("mesh", "pier", [1.0, height / 2, 0.0]), at("mesh", "pier", [4.0, height / 2, 0.0]),
                at("mesh", "lintel", [2.5, height - 0.4, 0.0]))
    scene.group("table", at("mesh", "top", [0.0, 0.74, 0.0]),
                at("mesh", "leg", [-0.66, 0.7, -0.37], array=[2, 1, 2], spacing=[1.32, 0.0, 0.74]),
                at("mesh", "vase", [0.35, 0.77, 0.1]))
    scene.group("chair", at("mesh", "seat", [0.0, 0.45, 0.0]), at("mesh", "back", [0.0, 0.75, -0.2]),
                at("mesh", "leg", [-0.18, 0.42, -0.18], scale=[0.7, 0.6, 0.7], array=[2, 1, 2], spacing=[0.36, 0.0, 0.36]))
    scene.group("shelf", at("mesh", "board", [0.0, 0.5, 0.0], array=[1, 5, 1], spacing=[0.0, 0.45, 0.0]),
                at("mesh", "book", [-0.7, 0.64, 0.0], array=[14, 4, 1], spacing=[0.075, 0.45, 0.0]))
    scene.group("room", at("group", "table", [2.4, 0.0, 2.2], rotate=[0.0, 20.0, 0.0]),
                at("group", "chair", [2.3, 0.0, 1.4], rotate=[0.0, 15.0, 0.0]),
                at("group", "chair", [2.7, 0.0, 3.1], rotate=[0.0, 200.0, 0.0]),
                at("group", "shelf", [1.1, 0.0, 0.28]), at("mesh", "vase", [4.3, 0.0, 0.6], scale=2.4),
                at("mesh", "wheel", [3.9, 2.3, 0.17], interpolation="linear", cycle=12,
                   keys=[{"time": 0, "rotate": [0, 0, 0]}, {"time": 12, "rotate": [0, 0, 360]}]),
                at("group", "idle_0", [1.2, 0.0, 2.9], rotate=[0.0, 100.0, 0.0]),
                at("group", "idle_1", [3.8, 0.0, 2.5], rotate=[0.0, 250.0, 0.0]))
    scene.object(at("group", "room", [0.0, 0.0, 0.0], array=[rooms_x, 1, rooms_z], spacing=[side, 0.0, side]))
    scene.object(at("group", "wall", [0.0, 0.0, 0.0], array=[rooms_x, 1, rooms_z + 1], spacing=[side, 0.0, side]))
    scene.object(at("group", "wall", [0.0, 0.0, 0.0], rotate=[0.0, -90.0, 0.0], array=[rooms_x + 1, 1, rooms_z],
                    spacing=[side, 0.0, side]))
    return scene


WAVES = [([1.0, 0.0, 0.35], 1.1, 46.0, 0.1), ([-0.4, 0.0, 1.0], 0.8, 31.0, 0.55), ([1.0, 0.0, -0.9], 0.22, 11.0, 0.3)]


def ground(x, z):
    """Height of the forest's floor, and how it rises along x and z."""
    height, rise_x, rise_z = 0.0, 0.0, 0.0
    for axis, amount, wavelength, phase in WAVES:
        length = math.hypot(axis[0], axis[2])
        ax, az = axis[0] / length, axis[2] / length
        turn = 2 * math.pi * ((ax * x + az * z) / wavelength + phase)
        height += amount * math.sin(turn)
        slope = amount * math.cos(turn) * 2 * math.pi / wavelength
        rise_x += slope * ax
        rise_z += slope * az
    return height, rise_x, rise_z


def forest(variant=None):
    scene = Scene("forest", ["A forest on hills: trees and plants that sway, creatures that pass. Written by benchmark.py."], "catmark", variant)
    head(scene, {"position": [3.0, 3.4, 27.0], "target": [-1.0, 2.2, 0.0], "fov": 48},
         [{"corner": [-52.0, 46.0, 30.0], "edge_u": [12.0, 10.0, 0.0], "edge_v": [-4.0, 4.8, 14.0], "radiance": [130, 115, 90]},
          facing([-1, -3, -4], [12.0, 40.0, 48.0], 6.0, 1.0, [6.0, 7.0, 8.3])],
         [0.42, 0.50, 0.60],
         {"soil": [0.30, 0.25, 0.16], "bark": [0.30, 0.21, 0.14], "needles": [0.10, 0.22, 0.11], "leaves": [0.24, 0.36, 0.10],
          "grass": [0.30, 0.40, 0.14], "fur": [0.46, 0.34, 0.24], "bloom": [0.75, 0.45, 0.20]})
    cells = 64
    scene.mesh("ground", "plane", "soil", {"width": 160.0, "depth": 160.0, "columns": cells, "rows": cells},
               deform=[{"kind": "wave", "axis": axis, "direction": [0, 1, 0], "amount": amount, "wavelength": wavelength,
                        "phase": phase} for axis, amount, wavelength, phase in WAVES])
    sway = {"kind": "bend", "axis": [0, 1, 0]}
    scene.mesh("trunk", "limb", "bark", {"segments": 9, "rings": 5, "length": 6.0, "joint": 0.12, "end": 0.34})
    scene.mesh("layer", "canopy", "needles", {"petals": 9, "middle": 0.75, "ridge": 0.25, "waist": 0.72},
               deform=[{"kind": "wave", "axis": [1, 0, 0.3], "direction": [0, 1, 0], "amount": 0.035, "wavelength": 1.3, "period": 2.3}])
    scene.mesh("leaf_ball", "urchin", "leaves", {"length": 0.55, "taper": 0.85},
               deform=[{"kind": "twist", "amount": 5.0, "period": 3.1}])
    for name, direction, amount, period in (("blade_0", [1, 0, 0.2], 34.0, 2.1), ("blade_1", [0.2, 0, 1], 28.0, 2.7)):
        scene.mesh(name, "limb", "grass", {"segments": 5, "rings": 4, "length": 0.6, "joint": 0.006, "end": 0.022},
                   deform=[{**sway, "origin": [0, -0.6, 0], "direction": direction, "amount": 45.0},
                           {**sway, "origin": [0, -0.6, 0], "direction": direction, "amount": amount, "period": period}])
    scene.mesh("flower", "dish", "bloom", {"petals": 5, "rings": 3, "rise": 0.5, "wave": 0.25}, scale=0.09)
    scene.mesh("fern", "canopy", "grass", {"petals": 11, "middle": 0.1, "ridge": 0.75, "waist": 0.6}, scale=0.5,
               deform=[{"kind": "wave", "axis": [1, 0, 0], "direction": [0, 1, 0], "amount": 0.05, "wavelength": 1.7, "period": 1.9}])
    scene.mesh("body", "limb", "fur", {"segments": 12, "rings": 4, "length": 0.8, "joint": 0.26, "end": 0.22}, rotate=[-90, 0, 0])
    scene.mesh("throat", "limb", "fur", {"segments": 10, "rings": 3, "length": 0.45, "joint": 0.11, "end": 0.14}, rotate=[145, 0, 0])
    scene.mesh("muzzle", "limb", "fur", {"segments": 10, "rings": 2, "length": 0.28, "joint": 0.13, "end": 0.07}, rotate=[-70, 0, 0])
    scene.mesh("shank", "limb", "fur", {"segments": 8, "rings": 3, "length": 0.62, "joint": 0.09, "end": 0.05})
    scene.mesh("tail", "limb", "fur", {"segments": 8, "rings": 6, "length": 0.6, "joint": 0.05, "end": 0.02}, rotate=[60, 0, 0],
               deform=[{**sway, "axis": [0, -1, 0], "direction": [1, 0, 0], "amount": 60.0, "period": 1.3}])
    for phase in range(2):
        scene.group(f"creature_{phase}", at("mesh", "body", [0.0, 0.85, 0.4]), at("mesh", "throat", [0.0, 0.95, 0.45]),
                    at("mesh", "muzzle", [0.0, 1.38, 0.72]), at("mesh", "tail", [0.0, 0.95, -0.5]),
                    *(at("mesh", "shank", [x, 0.72, z], **swing(24.0, 0.9, phase / 2 + turn))
                      for x, z, turn in ((0.15, 0.35, 0.0), (-0.15, 0.35, 0.5), (0.15, -0.35, 0.5), (-0.15, -0.35, 0.0))))
    rock = [{"time": t, "rotate": [1.5 * math.sin(math.pi * t / 2), 0.0, 1.5 * math.cos(math.pi * t / 2)]} for t in range(4)]
    nod = {"interpolation": "smooth", "cycle": 4, "keys": rock}
    scene.group("pine", at("mesh", "trunk", [0.0, 5.6, 0.0]),
                *(at("mesh", "layer", [0.0, 1.3 + 1.15 * k, 0.0], scale=[r, 1.5, r], **{**nod, "keys": list(rock)})
                  for k, r in enumerate((2.1, 1.8, 1.45, 1.05, 0.6))))
    scene.group("oak", at("mesh", "trunk", [0.0, 3.9, 0.0], scale=[1.3, 0.72, 1.3]),
                *(at("mesh", "leaf_ball", [x, y, z], scale=s, **{**nod, "keys": list(rock)})
                  for x, y, z, s in ((0.0, 4.6, 0.0, 1.25), (0.9, 3.9, 0.4, 0.9), (-0.8, 4.0, 0.5, 0.95), (0.1, 3.8, -0.9, 0.9))))
    chance = random.Random(11)
    for variant in range(3):
        blades = []
        for n in range(14):
            blades.append(at("mesh", f"blade_{n % 2}", [chance.uniform(-0.5, 0.5), 0.5, chance.uniform(-0.5, 0.5)],
                             rotate=[chance.uniform(-12, 12), chance.uniform(0, 360), chance.uniform(-12, 12)],
                             scale=chance.uniform(0.7, 1.2)))
        if variant != 1:
            blades += [at("mesh", "flower", [chance.uniform(-0.4, 0.4), 0.45, chance.uniform(-0.4, 0.4)],
                          rotate=[chance.uniform(-25, 25), 0.0, chance.uniform(-25, 25)]) for _ in range(2)]
        scene.group(f"tuft_{variant}", *blades)

    def stand(name, x, z, sink, **more):
        """On the ground, tilted with it."""
        height, rise_x, rise_z = ground(x, z)
        tilt = [math.degrees(math.atan(rise_z)), 0.0, -math.degrees(math.atan(rise_x))] if name.startswith("tuft") else [0.0] * 3
        tilt[1] = chance.uniform(0, 360) if not name.startswith("tuft") else 0.0
        kind = "mesh" if name == "fern" else "group"
        scene.object(at(kind, name, [x, height - sink, z], rotate=tilt, **more))

    placed = []
    while len(placed) < 170: # trees, apart, with a path left free
        x, z = chance.uniform(-42, 42), chance.uniform(-52, 22)
        path = 2.0 * math.sin(z / 9)
        if abs(x - path) < 3.2 or any(math.hypot(x - a, z - b) < 2.7 for a, b in placed):
            continue
        placed.append((x, z))
        stand("pine" if chance.random() < 0.62 else "oak", x, z, 0.25, scale=chance.uniform(0.75, 1.35))
    for _ in range(900):
        x, z = chance.uniform(-22, 22), 25.5 - 45 * chance.random() ** 1.4
        stand(f"tuft_{chance.randrange(3)}", x, z, 0.06, scale=chance.uniform(0.7, 1.3))
    for _ in range(160):
        stand("fern", chance.uniform(-24, 24), 24 - 44 * chance.random(), 0.05, scale=chance.uniform(0.6, 1.4))
    for n in range(9):
        x, z, heading = -9.0 + 2.4 * n + chance.uniform(-0.8, 0.8), 3.0 - 4.5 * (n % 4) + chance.uniform(-1, 1), -90.0 + chance.uniform(-35, 35)
        keys = []
        for step in range(0, 9):
            way = 0.9 * step
            px, pz = x + way * math.sin(math.radians(heading)), z + way * math.cos(math.radians(heading))
            keys.append({"time": step, "translate": [px, ground(px, pz)[0], pz]})
        scene.object(at("group", f"creature_{n % 2}", keys[0]["translate"], rotate=[0.0, heading, 0.0],
                        scale=chance.uniform(0.8, 1.15), interpolation="smooth", keys=keys))
    return scene


def showcase(variant=None):
    scene = Scene("showcase", ["Creased subdivision surfaces on turning plinths. Written by benchmark.py."], "catmark", variant)
    head(scene, {"position": [0.0, 4.6, 11.6], "target": [0.0, 1.1, -0.5], "fov": 43},
         [{"corner": [-5.5, 8.5, 3.5], "edge_u": [3.4, 0.0, 0.0], "edge_v": [0.0, -1.6, 3.2], "radiance": [28, 26, 23]},
          facing([-3, -2, -4], [8.0, 6.0, 11.0], 2.0, 0.25, [1.2, 1.3, 1.5])],
         [0.42, 0.45, 0.50],
         {"marble": [0.68, 0.66, 0.63], "jade": [0.20, 0.44, 0.32], "copper": [0.62, 0.30, 0.17], "ivory": [0.76, 0.71, 0.60],
          "ink": [0.09, 0.11, 0.20], "saffron": [0.74, 0.50, 0.12], "rose": [0.62, 0.24, 0.30], "hall": [0.46, 0.45, 0.44],
          **({"cream": [0.80, 0.74, 0.62], "chrome": [0.77, 0.78, 0.78]} if variant == "displaced" else {})})
    scene.mesh("hall", "plane", "hall", {"width": 40.0, "depth": 40.0})
    scene.mesh("backdrop", "plane", "hall", {"width": 40.0, "depth": 16.0}, rotate=[90, 0, 0], translate=[0.0, 6.0, -7.0])
    scene.mesh("plinth", "box", "marble", {"width": 1.5, "height": 0.9, "depth": 1.5, "sharpness": 3.2})
    pieces = (("knot", "jade", {"segments": 96}, 0.62, 0.85, 4.0), ("gear", "copper", {"teeth": 15, "sharpness": 2.6}, 0.72, 0.45, 6.0),
              ("sponge", "ivory", {"strut": 0.45, "sharpness": 2.0}, 0.52, 0.72, 9.0), ("urchin", "saffron", {"length": 0.9, "sharpness": 2.2}, 0.42, 0.78, 5.0),
              ("bowl", "ink", {"segments": 24}, 0.72, 0.02, 12.0), ("canopy", "rose", {"petals": 8}, 0.78, 0.12, 7.0),
              ("dish", "saffron", {"petals": 5, "rings": 5, "wave": 0.35}, 0.72, 0.25, 8.0), ("pawn", "ink", {"segments": 16}, 0.6, 0.0, 10.0))
    other = {"canopy": "chrome", "dish": "cream", "pawn": "rose"} if variant == "displaced" else {}
    for name, material, parameters, scale, _, _ in pieces:
        material = other.get(name, material)
        deform = [{"kind": "twist", "amount": 24.0, "period": 5.0}] if name in ("sponge", "pawn") else \
            [{"kind": "wave", "axis": [1, 0, 1], "direction": [0, 1, 0], "amount": 0.06, "wavelength": 1.1, "period": 2.0}] if name == "canopy" else []
        scene.mesh(name, "{}".format(name), material, parameters, scale=scale, deform=deform)
    for n, (name, _, _, _, lift, seconds) in enumerate(pieces):
        row, column = divmod(n, 4)
        x, z = (column - 1.5) * 2.5, -2.0 + 2.9 * row
        scene.object(at("mesh", "plinth", [x, 0.45, z]))
        upright = [90.0, 0.0, 0.0] if name == "gear" else [0.0, 0.0, 0.0]
        scene.group(f"{name}_stands", at("mesh", name, [0.0, 0.0, 0.0], rotate=upright))
        scene.object(at("group", f"{name}_stands", [x, 0.9 + lift, z], cycle=seconds,
                        keys=[{"time": 0, "rotate": [0, 0, 0]}, {"time": seconds, "rotate": [0, 360, 0]}]))
    return scene


def files():
    """Of every file that belongs beside this one: its name and bytes."""
    variants = [*itertools.product((courtyard, interior, forest, showcase), (None, "textured")), (showcase, "displaced")]
    for scene, variant in variants:
        yield f"{scene.__name__}{f'-{variant}' if variant else ''}.toml", scene(variant).write().encode()
    for name, heights in HEIGHTS.items():
        yield f"heights-{name}.png", height_map(*heights)


def main():
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit("usage: benchmark.py [--check]")
    folder = os.path.dirname(os.path.abspath(__file__))
    stale = []
    for name, data in files():
        file = os.path.join(folder, name)
        if not sys.argv[1:]:
            with open(file, "wb") as out:
                out.write(data)
        elif not os.path.exists(file) or open(file, "rb").read() != data:
            stale.append(file)
    if stale:
        sys.exit(f"{', '.join(stale)}: not what benchmark.py writes; run it")


if __name__ == "__main__":
    main()
