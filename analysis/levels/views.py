#!/usr/bin/python3
"""Levels of detail compared (levels.py) in several views of models: one table in Markdown.

    analysis/levels/views.py SCENES
    analysis/levels/views.py SCENES --only herd crowd --schemes recursive fixed fixed:1

SCENES is a folder of models; views.toml says which, from where they are seen, and what else differs. Views whose model
is not there are named and skipped. Other options are those of levels.py, for every view.
"""
import json
import os
import shlex
import sys
import tomllib

import levels
import view
from view import fail

COLUMNS = [
    ("scheme", lambda r: f"`{r['scheme']}`"),
    ("error", lambda r: f"{r['rmse']:.5f}"),
    ("noisy", lambda r: f"{r['noise']:.5f}"),
    ("camera rays, s", lambda r: f"{r['camera_seconds']:.3f}"),
    ("shadow rays, s", lambda r: f"{r['shadow_seconds']:.3f}"),
    ("camera, equal error", lambda r: levels.ratio(r, "camera", "fixed")),
    ("shadow, equal error", lambda r: levels.ratio(r, "shadow", "fixed")),
    ("camera, over `discrete`", lambda r: levels.ratio(r, "camera", "discrete")),
    ("shadow, over `discrete`", lambda r: levels.ratio(r, "shadow", "discrete")),
    ("first, camera", lambda r: levels.ratio(r, "first_camera", "fixed")),
    ("first, shadow", lambda r: levels.ratio(r, "first_shadow", "fixed")),
    ("triangles", lambda r: f"{r['triangles'] / 1e6:.2f} M"),
    ("made / needed", lambda r: f"{r['made_over_needed']:.2f}"),
    ("tests blended", lambda r: f"{r['blended']:.1%}"),
    ("grids, MB", lambda r: f"{r['grid_bytes'] / 1e6:.0f}"),
]


# Options of levels.py: the command line's, else a view's own, else these.
DEFAULTS = {"size": "128x128", "spp": 4, "repeat": 3, "frames": 3, "reference": 4, "reference_lod": "camera",
            "schemes": ["recursive", "discrete", "fixed", "fixed:1", "fixed:2"]}


def read_views(only):
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "views.toml"), "rb") as file:
        views = tomllib.load(file)["view"]
    names = [v["name"] for v in views]
    for name in only or []:
        if name not in names:
            fail(f"--only {name}: no such view; there are {', '.join(names)}")
    return [v for v in views if not only or v["name"] in only]


def main():
    parser = levels.parser()
    parser.description = __doc__
    parser.add_argument("scenes", metavar="SCENES")
    parser.add_argument("--only", nargs="+", metavar="VIEW")
    parser.set_defaults(**dict.fromkeys(DEFAULTS))
    given = parser.parse_args()
    if not os.path.isdir(given.scenes):
        fail(f"{given.scenes}: no such folder; give that of the models")
    all_rows, missing, views = {}, [], read_views(given.only)
    if given.write_scene and len(views) != 1:
        fail(f"--write-scene {given.write_scene}: of one view; say which with --only")
    if not given.write_scene:
        print("| view | " + " | ".join(name for name, _ in COLUMNS) + " |")
        print("|" + " --- |" * (len(COLUMNS) + 1))
    for v in views:
        model = os.path.join(given.scenes, v["model"])
        if not os.path.exists(model):
            if given.write_scene:
                fail(f"{model}: no such file; {v['name']} is seen in it")
            missing.append(f"{v['name']} ({v['model']})")
            continue
        own = levels.parse([model, *v["options"]])
        for name, default in DEFAULTS.items():
            value = getattr(given, name)
            setattr(own, name, v.get(name, default) if value is None else value)
        own.razor = given.razor or own.razor
        if given.write_scene:
            view.write_scene(own, given.write_scene)
            continue
        all_rows[v["name"]] = rows = levels.measure(own)
        for r in rows:
            print(f"| {v['name']} | " + " | ".join(text(r) for _, text in COLUMNS) + " |", flush=True)
    for v in missing:
        print(f"skipped: {v} is not there", file=sys.stderr)
    if given.json and not given.write_scene:
        with open(given.json, "w") as file:
            json.dump({"command": shlex.join(sys.argv), "views": all_rows}, file, indent=1)
            file.write("\n")


if __name__ == "__main__":
    view.run_program(main)
