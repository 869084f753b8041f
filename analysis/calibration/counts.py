"""What each kernel of a native build did: instructions and data references by phase of the frame, out of a profile by
callgrind, which counts as cachegrind does and knows who called whom.

A phase is entered by the functions that hold a phase_scope (razor/kernels), none of which is inlined. Whatever they call
of the vocabulary, of other kernels, and memcpy and the like, is done in the phase of its callers; what several phases
call is split in the proportion of what they had it do. What the host does (topology, files) does not count, nor does the
workers' entry with what it alone calls.
"""
import os
import re
from collections import defaultdict

EVENTS = ("Ir", "Dr", "Dw")  # instructions, data read, data written
MISSES = ("D1mr", "D1mw", "DLmr", "DLmw")  # of reads and writes, of the first and of the last level
LIBRARY = re.compile(r"(__)?mem(set|cpy|move)(?![a-z])")
SCOPE = re.compile(r"\bphase_scope\s+\w+\(phase_")
ENTRY = re.compile(r"(\w+)\s*\([^{};]*\)\s*\{\s*phase_scope\s+\w+\(phase_(\w+)\)")
OPERATOR = re.compile(r"\boperator\s*(\(\)|[-+*/%^&|~!=<>]+)")


class Malformed(Exception):
    """What is wrong with a profile, one line."""


class Profile:
    """A file that callgrind wrote with --cache-sim=yes: costs of each function alone, and of its calls of others."""

    def __init__(self, lines, name, wanted=EVENTS):
        self.wanted = wanted
        self.own = defaultdict(lambda: [0] * len(wanted))
        self.calls = defaultdict(lambda: [0] * len(wanted))  # (caller, callee): all that the callee did, its own calls too
        self.count = defaultdict(int)  # (caller, callee): how often
        self._names = {}
        columns, function, callee, called = None, None, None, False
        for number, line in enumerate(lines, 1):
            line = line.rstrip("\n")
            try:
                if line.startswith("events:"):
                    events = line.split()[1:]
                    columns = [events.index(e) for e in wanted]
                elif line.startswith("fn="):
                    function = self._name(line[3:])
                elif line.startswith("cfn="):
                    callee = self._name(line[4:])
                elif line.startswith("calls="):
                    self.count[function, callee] += int(line[6:].split()[0])
                    called = True
                elif line[:1].isdigit() or line[:1] in ("+", "-", "*"):
                    costs = line.split()[1:]
                    to = self.calls[function, callee] if called else self.own[function]
                    for i, column in enumerate(columns):
                        to[i] += int(costs[column]) if column < len(costs) else 0  # zeros at the end are left out
                    called = False
            except (ValueError, KeyError, TypeError) as error:
                raise Malformed(f"{name}:{number}: not as callgrind writes with --cache-sim=yes; count anew") from error
        if columns is None or not self.own:
            raise Malformed(f"{name}: not a profile of callgrind; count anew")

    def _name(self, text):
        match = re.fullmatch(r"\((\d+)\)(?: (.*))?", text)
        if not match:
            return text
        if match[2]:
            self._names[match[1]] = match[2]
        return self._names[match[1]]


def bare(function):
    """A demangled function's qualified name: no result, template arguments, parameters or marks of clones."""
    text = OPERATOR.sub("operator@", function.partition(" [")[0])
    out, depth = "", 0
    for character in text:
        if character in "<(":
            depth += 1
        elif character in ">)":
            depth -= 1
        elif depth == 0:
            out += character
    return out.removesuffix(" const").rpartition(" ")[2]


def entries(folder):
    """{function: phase} of the kernels' sources."""
    out = {}
    for name in sorted(os.listdir(folder)):
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            text = re.sub("//.*", "", file.read())
        found = ENTRY.findall(text)
        if len(found) != len(SCOPE.findall(text)):
            raise Malformed(f"{os.path.join(folder, name)}: a phase_scope does not begin a function's body")
        out.update(found)
    return out


class Kernels:
    """Costs of a profile by kernel."""

    def __init__(self, profile, isa, phase_of):
        self._profile = profile
        self._phase_of = phase_of
        self._ours = re.compile(rf"\b(razor|isa)::{isa}::")
        self._callers = defaultdict(dict)
        for (caller, callee), cost in profile.calls.items():
            self._callers[callee][caller] = cost[0]
        self._parts = {}
        self.by_kernel = defaultdict(lambda: [0.0] * len(profile.wanted))
        for function, cost in profile.own.items():
            for kernel, part in self.parts(function).items():
                for i in range(len(profile.wanted)):
                    self.by_kernel[kernel][i] += part * cost[i]

    def parts(self, function, below=()):
        """{kernel: part of what the function does that is for it}; parts sum to 1, or to less if not all is."""
        if function in self._parts:
            return self._parts[function]
        name = bare(function)
        ours = self._ours.search(name)
        phase = self._phase_of.get(name.rpartition("::")[2]) if ours else None
        if phase:
            out = {phase: 1.0}
        elif ours or LIBRARY.match(name):
            out = self._of_callers(function, below)
        else:
            out = {}
        if not below:
            self._parts[function] = out
        return out

    def _of_callers(self, function, below):
        callers = {c: w for c, w in self._callers[function].items() if w and c != function and c not in below}
        whole = sum(callers.values())
        out = defaultdict(float)
        for caller, weight in callers.items():
            for kernel, part in self.parts(caller, (*below, function)).items():
                out[kernel] += part * weight / whole
        return dict(out)


def _by_kernel(path, isa, sources, wanted):
    phase_of = entries(sources)
    with open(path, encoding="utf-8", errors="replace") as file:
        kernels = Kernels(Profile(file, path, wanted), isa, phase_of).by_kernel
    if not kernels:
        raise Malformed(f"{path}: no kernel of {isa} ran; count a build that has this target")
    return sorted(kernels.items())


def read_kernels(path, isa, sources):
    """{phase: {"instructions": n, "references": n}} of a callgrind file; `sources`: folder of the kernels. Throws
    Malformed, OSError."""
    return {k: {"instructions": round(c[0]), "references": round(c[1] + c[2])}
            for k, c in _by_kernel(path, isa, sources, EVENTS)}


def read_misses(path, isa, sources):
    """{phase: {"references": n, "first": n, "last": n}}: data references and misses of both levels. Throws as read_kernels()."""
    return {k: {"references": round(c[1] + c[2]), "first": round(c[3] + c[4]), "last": round(c[5] + c[6])}
            for k, c in _by_kernel(path, isa, sources, EVENTS + MISSES)}
