"""What the programs of this folder share: scenes with every default filled in and seen from somewhere, and renders."""
import json
import os
import re
import subprocess
import sys


def add_options(parser, size, repeat):
    parser.add_argument("--size", default=size)
    parser.add_argument("--spp", type=int, default=1)
    parser.add_argument("--repeat", type=int, default=repeat)
    parser.add_argument("--from", dest="origin", metavar="X,Y,Z", help="where the camera stands")
    parser.add_argument("--to", metavar="X,Y,Z", help="what it looks at")
    parser.add_argument("--fov", type=float, metavar="DEGREES")
    parser.add_argument("--array", metavar="NX,NY,NZ", help="copies of the model, or of a table of instances")
    parser.add_argument("--spacing", metavar="X,Y,Z", help="from one copy to the next")
    parser.add_argument("--razor", help="the renderer; without it, that of the PATH or of build/release")
    parser.add_argument("--json", metavar="FILE")


def fail(message):
    print(f"{os.path.basename(sys.argv[0])}: {message}", file=sys.stderr)
    sys.exit(2)


def run_program(main):
    """Runs a program of this folder; Ctrl-C ends it with a line and exit code 130."""
    try:
        main()
    except KeyboardInterrupt:
        print(f"{os.path.basename(sys.argv[0])}: stopped", file=sys.stderr)
        sys.exit(130)


def write_rows(rows, path):
    """As JSON, whole or not at all, if there is a path to write to."""
    if not path:
        return
    temporary = f"{path}.{os.getpid()}.tmp"
    try:
        try:
            with open(temporary, "w", encoding="utf-8") as file:
                json.dump(rows, file, indent=1)
                file.write("\n")
            os.replace(temporary, path)
        finally:
            if os.path.exists(temporary):
                os.remove(temporary)
    except OSError as error:
        fail(f"{path}: {error.strerror}; give a file in a folder that is there")


def run(command):
    """What a command prints, and the rusage of it."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    out = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        last = (out.strip().splitlines() or ["no message"])[-1]
        fail(f"{' '.join(command)}: {last}")
    return out, usage


def described(options):
    """The scene with every default filled in, seen from where the options say."""
    text, _ = run([options.razor, "render", *options.scene, "--size", options.size, "--spp", str(options.spp),
                   "--print-config"])
    if options.array and "[[object]]" not in text:
        text += "".join(f"\n[[object]]\nmesh = {name}\n" + "array = []\nspacing = []\n" * (n == 0)
                        for n, name in enumerate(re.findall(r"(?m)^\[\[mesh\]\]\nname = (.*)$", text)))
    for key, numbers in (("position", options.origin), ("target", options.to), ("array", options.array),
                         ("spacing", options.spacing)):
        if numbers:
            kind = int if key == "array" else float
            value = ", ".join(str(kind(x)) for x in numbers.split(","))
            text, found = re.subn(rf"(?m)^{key} = \[.*\]$", f"{key} = [{value}]", text, count=1)
            if not found:
                fail(f"the scene has no {key} to set; leave the option out")
    if options.fov:
        text = re.sub(r"(?m)^fov = .*$", f"fov = {options.fov}", text, count=1)
    if options.origin or options.to:
        text = re.sub(r"(?m)^focus_distance = .*\n", "", text, count=1)
    return text


def write_scene(options, scene):
    text = described(options)
    try:
        with open(scene, "w") as file:
            file.write(text)
    except OSError as error:
        fail(f"{scene}: {error.strerror}; give a file in a folder that is there")
    return scene


def render(options, scene, folder, name, *more):
    """A picture made by one thread, its statistics, and the rusage."""
    out, stats = os.path.join(folder, name + ".exr"), os.path.join(folder, name + ".json")
    _, usage = run([options.razor, "render", scene, "--threads", "1", "--stats", stats, "-o", out, *more])
    with open(stats) as file:
        return out, json.load(file)["statistics"], usage
