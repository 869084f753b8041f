"""What the simulated studies of this folder share: points, each a run of razor-sim on a part of a frame, whose figures are kept
in a folder, so that a study that was stopped goes on, and one that is done is drawn and told anew at once."""
import hashlib
import json
import os
import re
import statistics
import sys
import tempfile
import tomllib
from concurrent.futures import as_completed

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../sweep"))
import chance  # noqa: E402
import plot  # noqa: E402
import simulation  # noqa: E402
from simulation import Mistake  # noqa: E402

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
TILE = 16  # crops begin at multiples of so many pixels: of whole screen tiles
KIB, MIB = 1 << 10, 1 << 20
SCENES = ("courtyard", "interior", "forest", "showcase")
# Of frames of 1024 x 1024, in their middle: so that nobody sharing a tree takes most_operations at most.
CROPS = {"courtyard": (64, 32), "interior": (64, 32), "forest": (32, 32), "showcase": (48, 32)}
TRANSIENT = ("grids", "item lists", "kd nodes", "blended blocks")  # what a frame builds
# Two tiles of copernicus, with a core of two threads each, or all of it; their part of its memory channels.
MACHINES = {
    "copernicus": {"file": "configs/machines/copernicus.toml", "ways": ("worker", "tile", "chip"), "workers": (1, 4),
                   "settings": ("chip.tiles=2", "chip.cores=1", "chip.threads=2", "memory.channels=1")},
    "zen4-2c": {"file": "configs/machines/zen4-2c.toml", "ways": ("worker", "chip"), "workers": (1, 2), "settings": ()},
}
FULL = {**MACHINES, "copernicus": {**MACHINES["copernicus"], "ways": ("worker", "core", "tile", "chip"), "workers": (1, 16, 64),
                                   "settings": ("chip.tiles=2", "memory.channels=1")}}
FULL_CROPS = {"courtyard": (128, 128), "interior": (128, 128), "forest": (64, 64), "showcase": (96, 96)}


def bytes_of(text):
    found = re.fullmatch(r"([1-9][0-9]*)(KiB|MiB)", text.strip())
    if not found:
        raise Mistake(f"'{text}' is no size of a cache; write for example 256KiB or 2MiB")
    return int(found[1]) * {"KiB": KIB, "MiB": MIB}[found[2]]


def sizes_of(text):
    """'256KiB..8MiB' (doubling) or a list with commas; each once, the smallest first."""
    if ".." in text:
        first, last = (bytes_of(part) for part in text.split("..", 1))
        out = [first]
        while out[-1] * 2 <= last:
            out.append(out[-1] * 2)
        if last < first:
            raise Mistake(f"'{text}' ends before it begins; write for example 256KiB..8MiB")
        return out
    return sorted({bytes_of(part) for part in text.split(",")})


def name_of(size):
    return f"{size // MIB} MiB" if size % MIB == 0 else f"{size // KIB} KiB"


def numbers_of(option, text, least=0):
    try:
        out = [int(part) for part in text.split(",")]
    except ValueError:
        out = []
    if not out or min(out) < least:
        raise Mistake(f"{option} '{text}': give whole numbers from {least}, with commas")
    twice = [n for i, n in enumerate(out) if n in out[:i]]
    if twice:
        raise Mistake(f"{option} '{text}': {twice[0]} is given twice; give each number once")
    return out


def scene_file(name):
    return name if name.endswith(".toml") else os.path.join(ROOT, "configs/scenes", name + ".toml")


def crop_of(scene, wanted):
    """The middle of the picture, in whole tiles, as --crop takes it."""
    try:
        with open(scene, "rb") as file:
            size = tomllib.load(file).get("settings", {}).get("size", [512, 512])
    except (OSError, tomllib.TOMLDecodeError) as why:
        raise Mistake(f"{scene}: {getattr(why, 'strerror', None) or why}; give a scene that is there") from None
    if any(w < 1 or w > s for w, s in zip(wanted, size)):
        raise Mistake(f"a crop of {wanted[0]}x{wanted[1]} is no part of the {size[0]} x {size[1]} pixels of {scene}; give a smaller --crop")
    at = [(s - w) // 2 // TILE * TILE for s, w in zip(size, wanted)]
    return f"{at[0]},{at[1]},{wanted[0]},{wanted[1]}"


def figures_of(report):
    """What studies want of a report, in sums over the chip."""
    traffic, stack = report["traffic"], report["stack"]
    built, counters, twice = report["renderer"]["built"], report["renderer"]["counters"], report["renderer"]["duplicates"]

    def lines(column, wanted):
        return sum(row[column] for row in traffic if wanted(row))

    def transient(row):
        return row["structure"] in TRANSIENT

    return {
        "operations": report["core"]["vops"], "instructions": report["core"]["instructions"], "cycles": report["cycles"],
        # What the frame's threads took, without waiting for the last of them: of many tiles that is the time.
        "work_cycles": (sum(stack.values()) - stack["idle"]) / report["workers"],
        "waiting": stack["synchronise"] / max(1, sum(stack.values()) - stack["idle"]),
        "dram_reads": report["memory"]["reads"], "dram_writes": report["memory"]["writes"],
        "transient_reads": lines("memory_reads", transient),
        "transient_writes": lines("memory_writes", lambda row: transient(row) and row["phase"] != "frame end"),
        "transient_left": lines("memory_writes", lambda row: transient(row) and row["phase"] == "frame end"),
        "discarded": sum(report[level]["discarded"] for level in ("l1", "l2", "l3", "l4", "l5") if level in report),
        "built_bytes": sum(built[key] for key in ("grid_bytes", "node_bytes", "list_bytes")),
        "blocks": counters["blocks_made"],
        "duplicate_nodes": twice["kd_nodes"] / max(1, built["inner_nodes"] + built["leaves"]),
        "duplicate_blocks": twice["blocks"] / max(1, counters["blocks_made"]),
    }


class Folder:
    """Where the figures of points are kept, one file each, written whole."""

    def __init__(self, path, simulator):
        self.path, self.simulator = path, simulator
        try:
            os.makedirs(path, exist_ok=True)
        except OSError as error:
            raise Mistake(f"{path}: {error.strerror}; give a folder") from None
        if not os.access(path, os.W_OK):
            raise Mistake(f"{path}: cannot be written to; give another folder")

    def file(self, point):
        """Another program, machine or scene, or another option, is another point."""
        inputs = simulation.digest_of_inputs(self.simulator, os.path.join(ROOT, point["machine"]),
                                             point["options"][point["options"].index("--scene") + 1])
        key = json.dumps([inputs, point], sort_keys=True)
        return os.path.join(self.path, "point-" + hashlib.sha256(key.encode()).hexdigest()[:24] + ".json")

    def find(self, point):
        try:
            with open(self.file(point), encoding="utf-8") as file:
                kept = json.load(file)
        except (OSError, ValueError):
            return None
        return kept["figures"] if kept.get("point") == point else None

    def take(self, point):
        """The figures of a point; runs it if it was not yet."""
        figures = self.find(point)
        if figures is None:
            with tempfile.TemporaryDirectory() as folder:
                report = simulation.run(self.simulator, os.path.join(ROOT, point["machine"]), point["settings"],
                                        [*point["options"], "--no-native"], folder)
            figures = figures_of(report)
            temporary = self.file(point) + ".tmp"
            with open(temporary, "w", encoding="utf-8") as file:
                json.dump({"point": point, "figures": figures}, file, indent=1)
            os.replace(temporary, self.file(point))
        return figures

    def take_all(self, points, jobs):
        """The figures of each, in order; tells on the error stream what is done."""
        missing = [p for p in points if self.find(p) is None]
        print(f"{len(points)} points, {len(points) - len(missing)} of them are there", file=sys.stderr, flush=True)
        with simulation.Pool(jobs) as pool:
            runs = {pool.submit(self.take, point): point for point in missing}
            for done, run in enumerate(as_completed(runs), 1):
                figures = run.result()
                print(f"{done} of {len(missing)}: {runs[run]['name']}: {figures['operations'] / 1e6:.0f} M operations",
                      file=sys.stderr, flush=True)
        return [self.find(point) for point in points]


def point(name, machine, scene, crop, options, settings=(), workers=None, seed=0, frame=40):
    """A run: `machine` of MACHINES; `name` is for who waits."""
    return {"name": f"{name}, seed {seed}", "machine": machine["file"],
            "settings": [*machine["settings"], *settings],
            "options": ["--scene", scene, "--crop", crop, "--frame", str(frame), "--jitter", str(seed),
                        *(["--workers", str(workers)] if workers else []), *options]}


def mean(runs, key):
    return statistics.fmean(r[key] for r in runs)


def width(runs, key):
    """Half of the interval in which the mean of such runs lies, by 95 %."""
    return chance.half_width([r[key] for r in runs])


def best_of(ways, key):
    """Of {way: runs} the cheapest ones: the least mean, and all that chance alone may keep from it."""
    means = {way: mean(runs, key) for way, runs in ways.items()}
    least = min(means, key=means.get)
    return [way for way in ways
            if way == least or means[way] - means[least] <= chance.of_difference(width(ways[way], key), width(ways[least], key))]


def add_options(p, folder):
    p.add_argument("folder", metavar="FOLDER", help=folder)
    p.add_argument("--scenes", default=",".join(SCENES), metavar="NAMES", help="of configs/scenes, or scene files, with commas")
    p.add_argument("--l2", metavar="SIZES", help="per tile: 256KiB..8MiB doubles, or a list with commas; without it, 256KiB,1MiB,4MiB,"
                   " with --full 256KiB..8MiB")
    p.add_argument("--crop", metavar="WxH", help="of each scene's picture, in its middle; without it, some for each scene")
    p.add_argument("--seeds", metavar="NUMBERS", help="of noise: a run for each (--jitter); without it 1,2, with --full 1,2,3")
    p.add_argument("--frame", type=int, default=40, help="of the scenes' motion")
    p.add_argument("--most-operations", type=float, default=300e6, metavar="N", help="points that take more are named")
    p.add_argument("--full", action="store_true", help="whole tiles of 32 threads, larger crops, more sizes and seeds")
    p.add_argument("--jobs", type=int, default=1, metavar="N", help="runs side by side")
    p.add_argument("--simulator", metavar="PATH", help="razor-sim; else from the PATH or build/release")
    p.add_argument("--csv", metavar="FILE", help="the table, for programs; without it, in the folder")
    p.add_argument("--json", metavar="FILE", help="likewise")
    p.add_argument("--output", metavar="FILE", help="the plot, .svg or .png; without it, in the folder")


def parser(program, description):
    p = simulation.argparse.ArgumentParser(prog=program, description=description, allow_abbrev=False, exit_on_error=False,
                                           formatter_class=simulation.argparse.RawDescriptionHelpFormatter)
    p.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see {program} --help"))
    return p


def checked(options, more, name):
    """Options of add_options(), looked at and completed; `name` of files in the folder."""
    if options.jobs < 1:
        raise Mistake(f"--jobs {options.jobs}: give a number from 1")
    options.more = more
    options.sizes = sizes_of(options.l2 or ("256KiB..8MiB" if options.full else "256KiB,1MiB,4MiB"))
    options.seeds = numbers_of("--seeds", options.seeds or ("1,2,3" if options.full else "1,2"))
    options.scenes = options.scenes.split(",")
    crops = FULL_CROPS if options.full else CROPS
    wanted = None
    if options.crop:
        found = re.fullmatch(r"([1-9][0-9]*)x([1-9][0-9]*)", options.crop)
        if not found:
            raise Mistake(f"--crop '{options.crop}': give WIDTHxHEIGHT, for example 64x64")
        wanted = (int(found[1]), int(found[2]))
    options.crops = {scene: crop_of(scene_file(scene), wanted or crops.get(scene, (64, 64))) for scene in options.scenes}
    options.simulator = simulation.simulator(options.simulator)
    options.machines = FULL if options.full else MACHINES
    for option, ending in (("csv", ".csv"), ("json", ".json"), ("output", ".svg")):
        path = getattr(options, option)
        simulation.check_writable("--" + option, path)
        setattr(options, option, path or os.path.join(options.folder, name + ending))
    if not options.output.endswith((".svg", ".png")):
        raise Mistake(f"--output {options.output}: give a name that ends in .svg or .png")
    return options


def write_tables(options, rows):
    simulation.write_csv(options.csv, rows)
    temporary = options.json + ".tmp"
    with open(temporary, "w", encoding="utf-8") as file:
        json.dump(rows, file, indent=1)
        file.write("\n")
    os.replace(temporary, options.json)


def name_large(options, points, figures):
    """Says which points took more operations than they should."""
    large = [(f["operations"], p["name"]) for p, f in zip(points, figures) if f["operations"] > options.most_operations]
    if large:
        most, name = max(large)
        print(f"{len(large)} of {len(points)} points take more than {options.most_operations / 1e6:.0f} million operations, at most"
              f" {most / 1e6:.0f}: {name}; a smaller --crop takes less", file=sys.stderr)


def draw(options, picture, *data):
    """picture(pyplot, options, *data), if it can be drawn."""
    try:
        pyplot = plot.drawing()
    except Mistake as why:
        print(f"no plot: {why}", file=sys.stderr)
        return
    plot.save(picture(pyplot, options, *data), options.output)
