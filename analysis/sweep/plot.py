#!/usr/bin/python3
"""Draws what sweep.py and assumptions.py of this folder write with --csv.

    analysis/sweep/plot.py errors built-in.csv spot.csv --output errors.svg
    analysis/sweep/plot.py tornado tiny.csv --output tornado.png --top 20

errors: of each file, written with sweep.py --reference, the error of every row beside the host's seconds that it took,
with what chance leaves open; the reference itself is the ring at no error. Files are named by their names.
tornado: of a file of assumptions.py, what halving and doubling each assumed number does to the ratio of the two designs,
the farthest first; what is shaded around 1 and around the ratio with nothing changed means nothing.

FILE.svg or FILE.png; needs Debian's python3-matplotlib. Equal files give equal bytes. Exit code: 0; 2 on a mistake; 130 after
Ctrl-C.
"""
import argparse
import csv
import math
import os
import sys

import simulation
from simulation import Mistake


def drawing():
    """matplotlib without a screen, and without times or chance in its files."""
    try:
        import matplotlib
    except ImportError:
        raise Mistake("matplotlib is not there for /usr/bin/python3; as root: apt-get install python3-matplotlib") from None
    matplotlib.use("Agg")
    matplotlib.rcParams.update({"svg.hashsalt": "razor", "svg.fonttype": "none", "font.size": 9, "axes.grid": True, "grid.alpha": 0.3,
                                "axes.spines.top": False, "axes.spines.right": False})
    import matplotlib.pyplot
    return matplotlib.pyplot


def read(path, *columns):
    """Rows of a file, numbers where they are some; it must have these columns."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as why:
        raise Mistake(f"{path}: {getattr(why, 'strerror', None) or why}; give a file that --csv has written") from None
    if not rows:
        raise Mistake(f"{path}: no rows; give a file that --csv has written")
    missing = [c for c in columns if c not in rows[0]]
    if missing:
        raise Mistake(f"{path}: has no column {missing[0]}; write it with {SOURCES[columns]}")
    for number, row in enumerate(rows, 2):
        for column in columns:
            try:
                value = float(row[column])
            except (TypeError, ValueError):
                value = math.nan
            if not math.isfinite(value):
                raise Mistake(f"{path}: line {number}: {column} is {row[column]!r}, no number")
            row[column] = value
    return rows


ERRORS = ("error", "error_chance", "host_seconds")
RATIOS = ("ratio", "noise")
SOURCES = {ERRORS: "sweep.py --reference --csv", RATIOS: "assumptions.py --csv"}


def draw_errors(plot, options):
    """Error in percent over the host's seconds."""
    figure, axes = plot.subplots(figsize=(7, 4.2))
    for path in options.files:
        rows = read(path, *ERRORS)
        key = next(iter(rows[0]))
        tried = [r for r in rows if r[key] != "reference"]
        reference = [r for r in rows if r[key] == "reference"]
        if not tried or len(reference) != 1:
            raise Mistake(f"{path}: no run of the reference mode beside others; write it with sweep.py --reference --csv")
        at = [r["host_seconds"] for r in tried]
        line = axes.errorbar(at, [100 * r["error"] for r in tried], yerr=[100 * r["error_chance"] for r in tried],
                             marker="o", markersize=4, capsize=2, linewidth=1, label=stem(path))
        colour = line.lines[0].get_color()
        axes.plot([reference[0]["host_seconds"]], [0], marker="o", markersize=8, fillstyle="none", color=colour, linestyle="")
        for r in tried:
            axes.annotate(r[key], (r["host_seconds"], 100 * r["error"]), textcoords="offset points", xytext=(4, 4),
                          color=colour)
    axes.axhline(0, color="black", linewidth=0.6)
    low, high = axes.get_xlim()
    if low <= 0 or high > 5 * low:  # within less, a logarithmic axis has hardly a number
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter("{x:g}")
    axes.set_xlabel("host seconds (ring: the reference mode)")
    axes.set_ylabel(f"cycles beside the reference, % (by {key})")
    axes.legend(frameon=False)
    return figure


def draw_tornado(plot, options):
    """The ratio of two designs with each number halved and doubled."""
    if len(options.files) != 1:
        raise Mistake("tornado: give one file")
    rows = read(options.files[0], *RATIOS)
    base = [r["ratio"] for r in rows if r.get("verdict") == "unchanged"]
    if len(base) != 1 or not rows[0].keys() >= {"key", "value", "changed"}:
        raise Mistake(f"{options.files[0]}: no row of what is unchanged; write it with {SOURCES[RATIOS]}")
    bars = {}
    for number, r in enumerate(rows, 2):
        if r["verdict"] == "unchanged":
            continue
        try:
            bars.setdefault(r["key"], []).append((float(r["changed"]) > float(r["value"]), r["ratio"]))
        except ValueError as why:
            raise Mistake(f"{options.files[0]}: line {number}: {why}") from None
    reach = {key: max(abs(ratio - base[0]) for _, ratio in both) for key, both in bars.items()}
    shown = sorted(bars, key=lambda key: -reach[key])[: options.top]
    figure, axes = plot.subplots(figsize=(7, 1.2 + 0.24 * len(shown)))
    noise = rows[0]["noise"]
    for centre in (1, base[0]):
        axes.axvspan(centre * (1 - noise), centre * (1 + noise), color="black", alpha=0.1, linewidth=0)
    for place, key in enumerate(shown):
        for doubled, ratio in bars[key]:
            axes.barh(place, ratio - base[0], left=base[0], height=0.7, color="tab:orange" if doubled else "tab:blue",
                      alpha=0.8)
    axes.axvline(base[0], color="black", linewidth=0.8)
    axes.axvline(1, color="black", linewidth=0.8, linestyle=":")
    axes.set_yticks(range(len(shown)), shown)
    axes.invert_yaxis()
    handles = [plot.Rectangle((0, 0), 1, 1, color=c, alpha=0.8) for c in ("tab:blue", "tab:orange")]
    axes.legend(handles, ["halved", "doubled"], frameon=False, loc="lower right", bbox_to_anchor=(1, 1), ncol=2)
    axes.set_xlabel(f"cycles of the second design over the first's ({len(shown)} of {len(bars)} assumed numbers)")
    return figure


def stem(path):
    return os.path.splitext(os.path.basename(path))[0]


def parse(arguments):
    parser = argparse.ArgumentParser(prog="plot.py", description=__doc__, allow_abbrev=False, exit_on_error=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see plot.py --help"))
    parser.add_argument("kind", choices=sorted(KINDS))
    parser.add_argument("files", nargs="+", metavar="FILE.csv")
    parser.add_argument("--output", required=True, metavar="FILE", help="a picture: .svg or .png")
    parser.add_argument("--top", type=int, default=20, metavar="N", help="bars of a tornado; 20 by default")
    options = parser.parse_args(arguments)
    if os.path.splitext(options.output)[1] not in (".svg", ".png"):
        raise Mistake(f"--output {options.output}: name a .svg or .png file")
    if options.top < 1:
        raise Mistake(f"--top {options.top}: give a number from 1")
    return options


KINDS = {"errors": draw_errors, "tornado": draw_tornado}


def save(figure, output):
    """A picture, whole or not at all; equal figures give equal bytes."""
    begun = output + ".part" + os.path.splitext(output)[1]
    try:
        about = {"Date": None} if output.endswith(".svg") else {"Software": None}
        figure.savefig(begun, dpi=150, bbox_inches="tight", metadata=about)
        os.replace(begun, output)
    except OSError as why:
        raise Mistake(f"{output}: {why.strerror}; give a place that can be written") from None
    finally:
        if os.path.exists(begun):
            os.remove(begun)


def main():
    options = parse(sys.argv[1:])
    save(KINDS[options.kind](drawing(), options), options.output)


if __name__ == "__main__":
    sys.exit(simulation.main(main))
