#!/usr/bin/python3
"""Each rule of isa/lint.py refuses its bad snippet, on the marked line and for that rule alone, and passes the good one."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

LINT = sys.argv.pop(1)

# rule: [(bad lines, the one to be named marked by //!), ...], [good lines, ...]
RULES = {
    "memory": (
        ["const node& x = *p; //!", "n = p->count; //!", "x = load(data + p.host()->count); //!", "auto v = access::value(x); //!",
         "pointer<float> words = q;\n    x = words[2]; //!", "float raw = *(q.host()); //!"],
        ["vfloat a[3];\n    vfloat* c = a;\n    a[1] = *c;", "tally(c.counters->tests, 1);", "vfloat d = a * b;",
         "auto f = [](const vfloat& x) -> vfloat { return x; };", "x = load(field(p, &node::count));",
         "void (*run)(int) = nullptr;"]),
    "loop": (
        ["for (int i = 0; i < n; ++i) //!\n        x = x + 1.0F;", "while (more) //!\n        x = x + 1.0F;",
         "for (;;) { //!\n        x = x + 1.0F;\n    }"],
        ["for (int i = 0; i < 3; ++i)\n        x = x + 1.0F;", "for (int i = 0; i < isa::width; ++i)\n        x = x + 1.0F;",
         "for (int i = 0; i < limit; ++i)\n        x = x + 1.0F;", "for (sint i = 0; branch(i < n); ++i)\n        x = x + 1.0F;",
         "while (branch(any(m)))\n        m = clear_first(m);",
         "for (;;) {\n        if (branch(x > 1.0F))\n            break;\n    }", "for (const vfloat& a : planes)\n        x = x + 1.0F;"]),
    "one-access": (
        ["x = load(p) + load(q); //!", "store(q, load(p)); //!", "if (branch(load(p) > 0.0F)) //!\n        x = 1.0F;",
         "n = fetch_add(w, load_acquire(w)); //!", "vfloat v = gather(p, load_vector(q), m); //!"],
        ["x = load(p);\n    x = x + 1.0F;", "if (branch(x > 0.0F))\n        x = load(p);", "sfloat u = load(p), v = load(q);",
         "each([&](int k) { store(q + k, x); });\n    x = load(p);"]),
    "one-operand": (
        ["x = a * b + c * d; //!", "x = fma(a * b, c, d * d); //!", "x = max(abs(a), abs(b)); //!", "x = vfloat(s) * (a + b); //!",
         "x = a - b - c * d; //!", "x = f(a + b, g(c)); //!", "m = (a < b) & (c < d); //!"],
        ["x = fma(a, b, c * d);", "x = a * b;\n    vfloat y = c * d;\n    x = x + y;", "x = a + b + c;", "x = a * (2.0F * 3.0F) + b;",
         "for (int i = 0; i < 3; ++i)\n        x = load(q + (2 * i + 1));", "x = fma(as_float(i), vfloat(0.5F), a * b);"]),
    "site": (
        ["x = load( //!\n        field(p, &node::count));", "store(q, //!\n          x);"],
        ["x = load(field(p, &node::count));", "x = fma(x,\n            y, z);"]),
    "libm": (
        ["x = std::sin(y); //!", "x = __builtin_expf(y); //!", "float z = sqrtf(2.0F); //!"],
        ["x = sin(y);", "x = sqrt(y);"]),
    "recursion": (
        ["}\ninline sint again(sint k) { //!\n    return again(k - 1);\n", "}\ninline sint one(sint k) { //!\n    return two(k);\n}\n"
         "inline sint two(sint k) { //!\n    return one(k);\n"],
        ["}\ninline sint once(sint k) {\n    return twice(k);\n}\ninline sint twice(sint k) {\n    return k;\n",
         "}\ninline vvec select(const vmask& m, const vvec& a, const vvec& b) {\n    return {select(m, a.x, b.x)};\n"]),
    "allocation": (
        ["int* block = new int[4]; //!", "void* block = malloc(4); //!", "std::vector<int> list; //!"],
        ["pointer<float> block = allocate(c, n);", "List list = make_list(c);"]),
    "control": (
        ["goto out; //!", "thread_local int n = 0; //!", "std::mutex lock; //!", "if (branch(b) && ready) //!\n        x = 1.0F;"],
        ["if (branch(b & c))\n        x = 1.0F;", "if (constant_a && constant_b)\n        x = 1.0F;"]),
}
FILE = "inline constexpr int limit = 4;\ninline void kernel(pointer<node> p, pointer<float> q, sfloat x, sint n) {{\n    {}\n}}\n"


def lint(snippet):
    """[(line, rule)]"""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "kernel.h")
        with open(path, "w") as f:
            f.write(FILE.format(snippet))
        done = subprocess.run([sys.executable, LINT, path], capture_output=True, text=True)
        found = [(int(m[1]), m[2]) for m in re.finditer(r":(\d+): ([\w-]+): ", done.stdout)]
        assert done.stderr == "" and done.returncode == (1 if found else 0), done.stderr
        return found


class Rules(unittest.TestCase):
    def test_bad_is_refused(self):
        for rule, (bad, _) in RULES.items():
            for snippet in bad:
                marked = [n for n, line in enumerate(FILE.format(snippet).split("\n"), 1) if "//!" in line]
                with self.subTest(rule=rule, snippet=snippet):
                    self.assertEqual(sorted(set(n for n, r in lint(snippet) if r == rule)), marked)

    def test_good_passes(self):
        for rule, (_, good) in RULES.items():
            for snippet in good:
                with self.subTest(rule=rule, snippet=snippet):
                    self.assertEqual(lint(snippet), [])

    def test_allowed_lines_pass(self):
        self.assertEqual(lint("store(q, load(p)); // lint: allow one-access because it is a test"), [])
        self.assertEqual(lint("// lint: allow one-access because it is a test\n    store(q, load(p));"), [])
        self.assertNotEqual(lint("store(q, load(p)); // lint: allow one-access"), [])
        self.assertNotEqual(lint("store(q, load(p)); // lint: allow memory because it is another rule"), [])

    def test_comments_and_strings_are_not_code(self):
        self.assertEqual(lint('// goto *p->x\n    const char* s = "goto *p->x new";\n    /* std::vector\n       goto */'), [])


unittest.main()
