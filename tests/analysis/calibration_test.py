#!/usr/bin/python3
"""calibration_test.py FOLDER: what analysis/calibration (FOLDER) reads of a profile, and what it fits."""
import io
import math
import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import counts  # noqa: E402
import fit  # noqa: E402

SOURCES = os.path.join(sys.argv[1], "../../razor/kernels")
# A frame: `trace` (traverse) calls a helper and `meet` (intersect), `meet` calls the helper and memset, so does the host.
PROFILE = """version: 1
events: Ir I1mr Dr Dw
fl=(1) render.cpp
fn=(1) razor::Frame::render(int)
10 100 0 7 7
cfn=(2) razor::sse4::traverse_kernel::trace<razor::sse4::Features{true}, 1>(razor::sse4::Context const&)
calls=1 0
11 1000 0 300 200
cfn=(5) memset
calls=3 0
12 9000 0 0 9000
fn=(2)
20 400 1 40 4
+1 100
cfn=(3) isa::sse4::operator<(isa::sse4::vint const&, isa::sse4::vint const&) [clone .isra.0]
calls=2 0
* 100 0 20 10
cfi=(2) meet.h
cfn=(4) razor::sse4::intersect_kernel::meet(int) const [clone .part.0]
calls=1 0
22 400 0 60 50
fn=(3)
30 400 0 80 40
fn=(4)
40 90 0 5
cfn=(3)
calls=6 0
* 300 0 60 30
cfn=(5)
calls=1 0
* 10 0 0 9
fn=(5)
50 9010 0 0 9009
"""


def kernels(text):
    profile = counts.Profile(io.StringIO(text), "p")
    return counts.Kernels(profile, "sse4", {"trace": "traverse", "meet": "intersect"}).by_kernel


class Counts(unittest.TestCase):
    def test_costs_are_those_of_the_phase_in_which_they_arise(self):
        found = kernels(PROFILE)
        self.assertEqual(set(found), {"traverse", "intersect"})  # the host's are nobody's
        # A quarter of what the helper did was for `trace`, and a 901st of memset's for `meet`.
        self.assertEqual(found["traverse"], [500 + 100, 40 + 20, 4 + 10])
        memset = 10 / 9010
        expected = [90 + 300 + memset * 9010, 5 + 60, 30 + memset * 9009]
        for got, wanted in zip(found["intersect"], expected):
            self.assertAlmostEqual(got, wanted)

    def test_names_are_bare(self):
        for name, wanted in {
            "void razor::sse4::(anonymous namespace)::run<A<(b)1>, true>(C<D> const&)": "razor::sse4::::run",
            "isa::avx2::operator<<(isa::avx2::vint const&, int) [clone .constprop.0]": "isa::avx2::operator@",
            "razor::sse4::f<razor::sse4::g(int)::{lambda(int)#1}>(int)::{lambda()#2}::operator()() const":
                "razor::sse4::f::{lambda#2}::operator@",
            "memcpy": "memcpy",
        }.items():
            self.assertEqual(counts.bare(name), wanted)

    def test_other_targets_do_not_count(self):
        self.assertEqual(kernels(PROFILE.replace("sse4", "avx2")), {})

    def test_what_is_no_profile_is_refused_in_a_line(self):
        for text in ["", "events: Ir\n", "no profile\n", PROFILE.replace("Dw", "X"), PROFILE.replace("100 0 7 7", "100 0 x 7"),
                     PROFILE.replace("fn=(2)\n", "fn=(9)\n")]:
            with self.assertRaisesRegex(counts.Malformed, "^p(:[0-9]+)?: .*; count anew$"):
                counts.Profile(io.StringIO(text), "p")

    def test_every_phase_is_entered_by_functions_that_are_found(self):
        found = counts.entries(SOURCES)
        with open(os.path.join(SOURCES, "../frame/phases.h"), encoding="utf-8") as file:
            phases = {line.split(",")[0].strip().removeprefix("phase_") for line in file if line.startswith("    phase_")}
        self.assertEqual(set(found.values()), phases - {"count"})
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "k.h"), "w", encoding="utf-8") as file:
                file.write("void f() {\n    int a;\n    phase_scope p(phase_build);\n}\n")
            with self.assertRaisesRegex(counts.Malformed, "does not begin a function's body"):
                counts.entries(folder)


class Fit(unittest.TestCase):
    """A core whose spills halve with each register, and builds that it models exactly or nearly."""

    def setUp(self):
        self.slopes = ({"a": 100.0, "b": 300.0, "c": 40.0}, {"a": 700.0, "b": 90.0, "c": 200.0})
        work = {"a": (1000, 5000), "b": (2000, 900), "c": (500, 800)}
        self.simulated = {r: {k: {"instructions": w + s / 2**r, "references": 100 + s / 2**r} for k, (w, s) in work.items()}
                          for r in (1, 2, 3, 4, 6)}

    def build(self, registers, scalar, vector, noise=None):
        of_scalars, of_vectors = self.slopes
        return {k: {"instructions": (c["instructions"] + scalar * of_scalars[k] + vector * of_vectors[k]) * (noise or {}).get(k, 1),
                    "references": c["references"]} for k, c in self.simulated[registers].items()}

    def test_parameters_come_back(self):
        for registers in (1, 3, 6):
            for moves in ((0, 0), (0.35, 0), (0, 0.68), (7.5, 1.9)):
                found, error = fit.fit(self.build(registers, *moves), self.simulated, self.slopes, ["instructions", "references"])
                self.assertEqual(found, (registers, *moves))
                self.assertAlmostEqual(error, 0)

    def test_without_references_registers_come_back_where_they_are_given(self):
        found, _ = fit.fit(self.build(3, 0.5, 0.1), {3: self.simulated[3]}, self.slopes, ["instructions"])
        self.assertEqual(found, (3, 0.5, 0.1))

    def test_noise_remains_and_moves_little(self):
        noise = {"a": 1.1, "b": 0.9, "c": 1.05}
        counted = self.build(3, 2, 0.5, noise)
        (registers, *moves), error = fit.fit(counted, self.simulated, self.slopes, ["instructions", "references"])
        self.assertEqual(registers, 3)
        none = fit.error(fit.ratios(counted, self.simulated[3], self.slopes, (2, 0.5), ["instructions", "references"]))
        self.assertLess(error, none)  # than that of the moves before the noise
        self.assertGreater(error, 0.001)
        for more in ((0.5, 0), (-0.5, 0), (0, 0.1), (0, -0.1)):
            beside = fit.ratios(counted, self.simulated[3], self.slopes, [m + d for m, d in zip(moves, more)],
                                ["instructions", "references"])
            self.assertGreater(fit.error(beside), error)

    def test_too_much_and_too_little_weigh_alike(self):
        twice, half = {"a": {"instructions": 2.0}}, {"a": {"instructions": 0.5}}
        self.assertAlmostEqual(fit.error(twice), math.log(2))
        self.assertAlmostEqual(fit.error(half), math.log(2))


unittest.main(argv=sys.argv[:1])
