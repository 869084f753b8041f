"""What scripts that set estimates beside whole runs share: their command lines, and which program they run."""
import argparse
import os
import shutil
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../sweep"))
import simulation  # noqa: E402


def parser_of(description):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--program", default=shutil.which("razor-sim") or "build/release/sim/program/razor-sim")
    return parser


def parsed(parser):
    """The options, and what stands after `--`, which is razor-sim's."""
    own, more = sys.argv[1:], []
    if "--" in own:
        at = own.index("--")
        own, more = own[:at], own[at + 1:]
    found = parser.parse_args(own)
    if shutil.which(found.program) is None:
        parser.error(f"{found.program} is no program; name razor-sim's place by --program")
    return found, more


def digest_of_inputs(program, machine, scene):
    """As simulation.py has it; ends the program where that cannot be told."""
    try:
        return simulation.digest_of_inputs(program, machine, scene)
    except simulation.Mistake as mistake:
        sys.exit(f"{os.path.basename(sys.argv[0])}: {mistake}")
