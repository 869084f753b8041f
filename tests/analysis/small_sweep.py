"""A sweep of four points, two of which fail, and what is left of it when all are done: for tests of the programs that run sweeps."""
import csv
import os


def write(folder, project):
    """study.toml and its scene."""
    study = f"""kind = "sweep"
[settings]
machine = "{project}/configs/machines/tiny.toml"
scene = "box.toml"
size = "16x16"
samples = 1
[knobs]
core.lanes = [4, 8]
workers = [2, 100]
"""
    for name, text in (("box.toml", '[[mesh]]\nshape = "box"\n'), ("study.toml", study)):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)


def snakemake(project, simulator, out, *options):
    """The command that runs the sweep, in the folder where it was written."""
    return ["snakemake", "-s", os.path.join(project, "analysis/sweep/Snakefile"), *options, "--config", "study=study.toml",
            f"folder={out}", f"simulator={simulator}"]


def environment(folder, own):
    """In which Snakemake leaves nothing outside the folder."""
    return dict(own, HOME=folder, XDG_CACHE_HOME=os.path.join(folder, "cache"))


def check_collected(test, out):
    with open(os.path.join(out, "study.csv"), encoding="utf-8") as file:
        states = sorted(row["state"].split(":")[0] for row in csv.DictReader(file))
    test.assertEqual(states, ["failed", "failed", "measured", "measured"])
    test.assertTrue(os.path.exists(os.path.join(out, "study.html")))
