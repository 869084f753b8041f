"""Study files of assumptions.py: what is compared, on which machine, of which frame; its page; and what has been run so far.

    kind = "assumptions"
    title = "..."
    seeds = 5                                              # that noise is measured with
    designs = ["kdtree.share=tile", "kdtree.share=worker"]
    only = ["memory", "l2"]                                # beginnings of keys to change; without it, all
    [settings]                                             # as of sweeps: the frame's, and any key of machine files
    machine = "../machines/copernicus.toml"                # files are named from the study's
    size = "32x32"
    chip.tiles = 1
    [full]                                                 # takes the place of these where --full is given
"""
import hashlib
import html
import io
import json
import os
import tomllib

import plot
import simulation
from simulation import Mistake

# Settings of the frame, and the options of razor-sim run that make them.
OPTIONS = {"scene": "--scene", "size": "--size", "samples": "--spp", "light_samples": "--light-samples",
           "sky_samples": "--sky-samples", "edge_pixels": "--edge-pixels", "frame": "--frame", "seed": "--seed",
           "workers": "--workers"}
KEYS = {"kind", "title", "seeds", "designs", "only", "settings", "full"}


def laid_over(table, over):
    return {**table, **{k: laid_over(table.get(k, {}), v) if isinstance(v, dict) else v for k, v in over.items()}}


def flat(table, before=""):
    """Settings by their whole names: section.key."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from flat(value, f"{before}{key}.")
        else:
            yield before + key, value


def read(path, full):
    """The study's tables, those of [full] laid over them where asked for."""
    try:
        with open(path, "rb") as file:
            study = tomllib.load(file)
    except OSError as why:
        raise Mistake(f"{path}: {why.strerror}; give a study of kind \"assumptions\"") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as why:
        raise Mistake(f"{path}: {why}") from None
    if study.get("kind") != "assumptions":
        raise Mistake(f"{path}: kind is {study.get('kind')!r}; this program measures \"assumptions\", razor-sim sweep others")
    over = study.pop("full", {})
    for key in {*study, *over} - KEYS:
        raise Mistake(f"{path}: unknown key {key}; there are {', '.join(sorted(KEYS))}")
    study = laid_over(study, over if full else {})
    designs = study.get("designs")
    if not isinstance(designs, list) or len(designs) != 2 or not all(isinstance(d, str) for d in designs):
        raise Mistake(f"{path}: designs is {designs!r}; give two, such as [\"kdtree.share=tile\", \"kdtree.share=worker\"]")
    if not isinstance(study.get("settings"), dict) or not isinstance(study["settings"].get("machine"), str):
        raise Mistake(f"{path}: there is no settings.machine; name a machine's file")
    return study


def arguments(path, study):
    """What assumptions.py would be given for it: options of its own, and those of every run."""
    base, own, more = os.path.dirname(path), [], ["--no-native", "--no-calibration"]
    for key, value in flat(study["settings"]):
        if isinstance(value, list):
            raise Mistake(f"{path}: {key} is a list; give one value")
        if key == "machine":
            own += ["--machine", os.path.join(base, value)]
        elif key == "scene":
            more += ["--scene", os.path.join(base, value)]
        elif key in OPTIONS:
            more += [OPTIONS[key], str(value)]
        elif "." in key:
            more += ["-g", f"{key}={value}"]
        else:
            raise Mistake(f"{path}: unknown setting {key}; there are machine, {', '.join(OPTIONS)}, and keys of machine files")
    own += ["--designs", *study["designs"], "--seeds", str(study.get("seeds", 10))]
    if study.get("only"):
        own += ["--only", *study["only"]]
    return own, more


class Kept:
    """Results of runs in a folder, each in a file named by all that it depends on: what is there is not run again."""

    def __init__(self, folder):
        self.folder = folder
        try:
            os.makedirs(folder, exist_ok=True)
        except OSError as why:
            raise Mistake(f"{folder}: {why.strerror}; give -o a folder that can be written") from None

    def run(self, run, program, machine, settings, more, scratch):
        """run(...), or what it has said before."""
        path = os.path.join(self.folder, self.name(program, machine, settings, more) + ".json")
        try:
            with open(path, encoding="utf-8") as file:
                return json.load(file)
        except (OSError, ValueError):
            pass
        report = run(program, machine, settings, more, scratch)
        kept = {key: report[key] for key in ("cycles", "machine", "machine_provenance")}
        with open(path + ".tmp", "w", encoding="utf-8") as file:
            json.dump(kept, file)
        os.replace(path + ".tmp", path)
        return kept

    @staticmethod
    def name(program, machine, settings, more):
        scenes = tuple(more[i + 1] for i, word in enumerate(more) if word == "--scene")
        inputs = simulation.digest_of_inputs(program, machine, *scenes)
        return hashlib.sha256(json.dumps([inputs, settings, more]).encode()).hexdigest()[:32]


def write_page(path, title, lines, csv, top):
    """One file with the conclusion, the tornado, and every change. Without matplotlib, without the drawing."""
    try:
        class Options:
            files = [csv]
        Options.top = top
        drawn = io.StringIO()
        figure = plot.draw_tornado(plot.drawing(), Options)
        figure.savefig(drawn, format="svg", bbox_inches="tight", metadata={"Date": None})
        text = drawn.getvalue()
        drawing = text[text.index("<svg"):]
        plot.save(figure, os.path.splitext(path)[0] + ".png")
    except Mistake as why:
        drawing = f"<p>No drawing: {html.escape(str(why))}</p>"
    page = ("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title></head>\n<body><h1>{0}</h1>\n"
            "<p>{1}</p>\n<p>{2}</p>\n{3}\n<pre>{4}</pre></body></html>\n").format(
                *map(html.escape, (title, lines[0], lines[-1])), drawing, html.escape("\n".join(lines[1:-1])))
    with open(path + ".tmp", "w", encoding="utf-8") as file:
        file.write(page)
    os.replace(path + ".tmp", path)
