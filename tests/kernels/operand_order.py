#!/usr/bin/env python3
"""Checks that no expression of the kernels leaves the order of two vocabulary operations to the compiler.

C++ does not say which operand of a call or operator is evaluated first, and compilers differ; in the simulated
machine the order of operations is the order of time. So at most one operand of an expression may hold an operation.
(Braces are evaluated in order; so are shifts and assignments.) Reads clang's syntax tree of the simulated kernels,
templates instantiated. Usage: operand_order.py CLANG++ SOURCE_FOLDER
"""
import json
import re
import subprocess
import sys

FLAGS = ["-std=c++20", "-DISA_TARGET=simulated", "-DISA_TARGET_SIMULATED=1", "-DISA_VALUES_PLAIN=1", "-DISA_WIDTH=32"]
FREE = {"field", "as", "lane_index", "as_int", "as_float", "tally"}  # no time passes in these
ORDERED = {"operator=", "operator+=", "operator-=", "operator<<", "operator>>", "operator[]", "operator()"}
CALLS = {"CallExpr", "CXXOperatorCallExpr", "CXXMemberCallExpr"}
CONSTRUCTIONS = {"CXXConstructExpr", "CXXTemporaryObjectExpr"}
# Host functions have none of these in their types.
VOCABULARY = re.compile(r"\b([sv](float|int|bool|mask|vec|point)|pointer<|shared_word|[A-Z]\w+)")


class Checker:
    def __init__(self):
        self.file, self.line, self.found = None, None, set()

    def move(self, place):
        """Clang names file and line only where they change."""
        place = place.get("expansionLoc", place)
        self.file = place.get("file", self.file)
        self.line = place.get("line", self.line)

    def operations(self, node):
        """The number of operations in a subtree; notes the calls whose operands compete."""
        if not isinstance(node, dict) or "kind" not in node:
            return 0
        self.move(node.get("loc", {}))
        self.move(node.get("range", {}).get("begin", {}))
        here = (self.file, self.line)
        self.move(node.get("range", {}).get("end", {}))
        kind = node["kind"]
        inside = [self.operations(child) for child in node.get("inner", [])]
        own, competing, name = 0, [], ""
        if kind == "LambdaExpr":
            return 0
        if kind in CALLS and inside:
            name, type_ = callee(node)
            own = 0 if is_free(name, type_) else 1
            competing = [] if name in ORDERED else inside[1:]
        elif kind in CONSTRUCTIONS:
            name = node["type"]["qualType"]
            own = 1 if is_broadcast(node) else 0
            competing = [] if node.get("list") else inside
        elif kind == "BinaryOperator" and node.get("opcode") not in {",", "&&", "||", "=", "<<", ">>"}:
            name, competing = node["opcode"], inside
        if sum(1 for n in competing if n > 0) > 1:
            self.found.add((*here, name))
        return own + sum(inside)


def callee(node):
    called = node["inner"][0]
    while called.get("kind") in {"ImplicitCastExpr", "ParenExpr"}:
        called = called["inner"][0]
    declaration = called.get("referencedDecl", called)
    return declaration.get("name", "?"), declaration.get("type", {}).get("qualType", "")


def is_free(name, type_):
    constant_step = name == "operator+" and "pointer<" in type_ and re.search(r", int\)", type_)
    return name in FREE or constant_step or not VOCABULARY.search(type_)


def is_broadcast(node):
    from_scalar = re.search(r"const (\w+::)*(sfloat|sint|sbool) &", node.get("ctorType", {}).get("qualType", ""))
    return from_scalar and re.search(r"\b(vfloat|vint|vmask)\b", node["type"]["qualType"])


def syntax_trees(compiler, source, kernels):
    command = [compiler, *FLAGS, f"-I{source}", "-fsyntax-only", "-Xclang", "-ast-dump=json",
               "-Xclang", "-ast-dump-filter=razor::simulated", f"{source}/razor/kernels/{kernels}"]
    text = subprocess.run(command, check=True, stdout=subprocess.PIPE, encoding="utf-8").stdout
    decoder, at = json.JSONDecoder(), 0
    while at < len(text):
        tree, at = decoder.raw_decode(text, at)
        yield tree
        while at < len(text) and text[at].isspace():
            at += 1


def main():
    checker = Checker()
    for kernels in ("kernels.cpp", "mapped.cpp", "glossy.cpp", "glossy_mapped.cpp"):
        operations = sum(checker.operations(tree) for tree in syntax_trees(sys.argv[1], sys.argv[2], kernels))
        if operations < 1000:
            sys.exit(f"only {operations} operations found: this check no longer sees {kernels}")
    for file, line, name in sorted(checker.found, key=str):
        print(f"{file}:{line}: operands of {name} are operations whose order the compiler chooses; take them apart")
    sys.exit(1 if checker.found else 0)


main()
