#!/usr/bin/python3
"""lint.py FILE... [--constants FILE...]: what kernels must not do and the types cannot refuse. Prints FILE:LINE: RULE: why; exits with 1 if any.

  memory      frame data touched other than by the vocabulary: *p, ->, p[i] on handles, .host(), access::
  loop        a loop over a bound that is neither a constant nor branch(): constants are literals, constexpr names,
              template parameters and isa::width
  one-access  two memory operations, branches or atomics in one full expression
  one-operand two operands of one operator or call that each compute something: compilers order them differently, and
              so would the machine. `fma(a, b, c * d)` is fine, `a * b + c * d` is not
  site        a memory operation, branch or atomic split over lines
  libm        the C library's mathematics
  recursion   a function that calls itself, or two that call each other (by name and number of arguments)
  allocation  new, malloc, containers, strings
  control     goto, virtual, thread_local, mutexes and threads, && and || beside branch()

A line with `// lint: allow RULE because ...`, or the line after one that holds nothing else, is let through.
The files are read together, so name all of them at once; those after --constants only lend their names. It is a reader of tokens, not a compiler: it knows names, not types.
"""
import re
import sys

ACCESSES = {"load", "load_vector", "load_broadcast", "store", "store_vector", "gather", "scatter", "prefetch", "discard",
            "load_acquire", "store_release", "fetch_add", "compare_exchange", "wait_while", "branch", "request_page"}
FREE_CALLS = {"field", "as", "as_int", "as_float", "lane_index", "sizeof", "static_cast", "offsetof"}
CONVERSIONS = {"vfloat", "vint", "vmask"} # of a scalar: a broadcast; F stands for either where a function is for both
FREE_CALLS |= {"sfloat", "sint", "sbool", "pointer"}
TYPES = CONVERSIONS | {"sfloat", "sint", "sbool", "pointer"}
OVERLOADED = ACCESSES | {"select", "permute", "compress", "extract", "min", "max", "abs", "sqrt", "fma", "fms", "fnma", "any",
                         "all", "none", "count", "first", "reciprocal", "reduce_add", "reduce_min", "reduce_max"}
KEYWORDS = {"if", "while", "for", "switch", "return", "else", "do", "case", "default", "const", "constexpr", "inline",
            "template", "using", "struct", "class", "enum", "namespace", "static", "auto", "sizeof", "decltype", "operator",
            "requires", "typename", "static_assert", "alignas", "public", "private", "explicit", "catch"}
LIBM = {"sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "exp2", "log", "log2", "log10", "pow", "sqrt", "cbrt",
        "fma", "floor", "ceil", "round", "trunc", "fabs", "abs", "fmod", "hypot", "min", "max"}
TOKEN = re.compile(r"[A-Za-z_]\w*|0[xX][0-9a-fA-F']+\w*|\d[\w.']*(?:[eE][-+]?\d+\w*)?|->\*?|::|<<=|>>=|<=|>=|==|!=|&&|\|\|"
                   r"|\+\+|--|<<|[-+*/%&|^]=|[^\s\w]")
CLOSING = {"(": ")", "[": "]", "{": "}"}
PRECEDENCE = [["*", "/", "%"], ["+", "-"], ["<", ">", "<=", ">="], ["==", "!="], ["&"], ["^"], ["|"]]


def blank(text):
    """The same text with comments, literals of characters and preprocessor lines blanked, and what lines allow."""
    allowed = {}
    for number, line in enumerate(text.splitlines(), 1):
        m = re.search(r"// lint: allow ([\w-]+) because \S", line)
        if m:
            allowed.setdefault(number + (not line.split("//")[0].strip()), set()).add(m[1])
    keep_lines = lambda m: re.sub(r"[^\n]", " ", m[0])
    text = re.sub(r'"(?:\\.|[^"\\\n])*"', lambda m: '"' + " " * (len(m[0]) - 2) + '"', text)
    text = re.sub(r"//[^\n]*|/\*.*?\*/", keep_lines, text, flags=re.S)
    text = re.sub(r"(?m)^\s*#(?:[^\n]*\\\n)*[^\n]*", keep_lines, text)
    return text.replace('"', " "), allowed


class Tokens:
    def __init__(self, text):
        self.word, self.line = [], []
        for number, line in enumerate(text.split("\n"), 1):
            for m in TOKEN.finditer(line):
                self.word.append(m[0])
                self.line.append(number)
        self.match, stack = {}, []
        for i, w in enumerate(self.word):
            if w in CLOSING:
                stack.append(i)
            elif w in CLOSING.values() and stack:
                opened = stack.pop()
                self.match[opened], self.match[i] = i, opened

    def at(self, i):
        return self.word[i] if 0 <= i < len(self.word) else ""

    def split(self, begin, end, at=","):
        """[begin, end) cut at the tokens `at` outside brackets."""
        parts, start, i = [], begin, begin
        while i < end:
            if self.word[i] in CLOSING:
                i = self.match.get(i, end)
            elif self.word[i] == at:
                parts.append((start, i))
                start = i + 1
            i += 1
        return parts + [(start, end)] if end > begin else []


def is_name(word):
    return bool(re.match(r"[A-Za-z_]", word))


class Lint:
    def __init__(self, paths, constants=()):
        self.found, self.calls, self.defined = [], {}, {}
        self.sources = [(p, *blank(open(p).read())) for p in paths]
        everything = "\n".join([text for _, text, _ in self.sources] + [blank(open(p).read())[0] for p in constants])
        self.constants = {"width", "true", "false", "nullptr"}
        self.constants |= set(re.findall(r"constexpr\s+[\w:<> ]*?\b(\w+)\s*(?:\[\w*\])?\s*[={]", everything))
        for parameters in re.findall(r"template\s*<([^>]*)>", everything):
            self.constants |= set(re.findall(r"\b(?:int|bool|auto|unsigned)\s+(\w+)", parameters))
        for body in re.findall(r"\benum\b[^{;]*\{([^}]*)\}", everything):
            self.constants |= set(re.findall(r"\b([A-Za-z_]\w*)\s*(?:=[^,]*)?(?:,|$)", body))
        self.plain = self.constants | set(re.findall(r"\b(?:int|bool|unsigned|std::u?int\d+_t|float)\s+(\w+)\s*[=;,:)]", everything))
        self.handles = set(re.findall(r"\bpointer<[^;(){}=]*>&?\s+(\w+)\s*[;,)={(]", everything))
        self.registers = set(re.findall(r"\b(?:[vs](?:float|int|mask|bool)|[vs]vec\w*)\s*\*\s*(?:const\s+)?(\w+)", everything))

    def run(self):
        for self.path, text, self.allowed in self.sources:
            self.t = Tokens(text)
            self.simple_rules()
            self.functions()
            self.expressions()
        self.recursion()
        for path, line, rule, why in sorted(set(self.found)):
            print(f"{path}:{line}: {rule}: {why}")
        return 1 if self.found else 0

    def report(self, i, rule, why):
        line = self.t.line[i]
        if rule not in self.allowed.get(line, ()):
            self.found.append((self.path, line, rule, why))

    def constant(self, begin, end):
        return all(not is_name(w) or w in self.plain or w == "sizeof" or self.t.at(i + 1) == "::"
                   for i, w in enumerate(self.t.word[begin:end], begin))

    # --- one token and its neighbours
    def simple_rules(self):
        t = self.t
        for i, w in enumerate(t.word):
            before, after = t.at(i - 1), t.at(i + 1)
            if w == "->" and not self.trailing_type(i) and not self.inside_call(i, "tally", "mark", "note_time", "note_dropping", "note_event", "begin_lap", "end_lap"):
                self.report(i, "memory", "-> reads memory that the machine does not see")
            if w == "host" and before in (".", "->") and after == "(":
                self.report(i, "memory", ".host() is for host code")
            if w == "access" and after == "::":
                self.report(i, "memory", "access:: is the vocabulary's own door to payloads")
            if w == "[" and t.at(i - 2) not in (".", "->") and self.declared_handle(i - 1):
                self.report(i, "memory", f"{before}[...] indexes a handle: load(handle + index)")
            if w == "*" and (before in ("", "(", ",", "=", ";", "{", "}", "return", "[", "?", ":", "!", "&&", "||")) and \
                    (is_name(after) or after == "(") and after not in self.registers and after != "this" and \
                    t.at(i - 2) != "void" and not self.inside_call(i, "request_page", "mark", "note_time", "note_dropping", "note_event", "begin_lap", "end_lap"):
                self.report(i, "memory", f"*{after} reads memory that the machine does not see")
            if w in ("while", "for") and after == "(":
                self.loop(i)
            if w in ACCESSES and after == "(" and before not in (".", "->", "::") and not self.is_definition(i):
                if t.line[i] != t.line[t.match.get(i + 1, i)]:
                    self.report(i, "site", f"{w}(...) spans lines: compilers number such calls differently")
            if w in LIBM and before == "::" and t.at(i - 2) in ("std", "") and after == "(":
                self.report(i, "libm", f"std::{w}: use the vocabulary (isa/isa.h, isa/math.h)")
            if re.fullmatch(r"__builtin_(sin|cos|tan|exp|log|pow|sqrt|fma|floor)\w*|(sin|cos|tan|exp|log|pow|sqrt|fma|floor)f", w):
                self.report(i, "libm", f"{w}: use the vocabulary (isa/isa.h, isa/math.h)")
            if (w == "new" or w == "delete" and before != "=") and before != "operator":
                self.report(i, "allocation", f"{w}: kernels allocate from arenas")
            if w in ("malloc", "calloc", "realloc", "free", "alloca") and after == "(" and before != ".":
                self.report(i, "allocation", f"{w}: kernels allocate from arenas")
            if before == "::" and t.at(i - 2) == "std":
                if w in ("vector", "string", "map", "unordered_map", "set", "deque", "list", "function", "unique_ptr",
                         "shared_ptr", "make_unique", "make_shared", "optional", "any"):
                    self.report(i, "allocation", f"std::{w}: kernels allocate from arenas")
                if w in ("mutex", "lock_guard", "scoped_lock", "thread", "jthread", "atomic", "atomic_ref",
                         "condition_variable", "barrier", "latch"):
                    self.report(i, "control", f"std::{w}: workers meet in shared<T> only")
            if w in ("goto", "virtual", "thread_local"):
                self.report(i, "control", f"{w} has no place in a kernel")

    def declared_handle(self, i):
        """Whether the nearest declaration of the name at i, before it, makes it a pointer<T>."""
        t = self.t
        for j in range(i - 1, 0, -1):
            if t.word[j] == t.word[i] and (is_name(t.word[j - 1]) and t.word[j - 1] not in KEYWORDS - {"auto", "const"} or
                                           t.word[j - 1] in (">", "&", "*")) and t.at(j + 1) in ("=", ";", ",", ")", "(", "[", "{"):
                return t.word[i] in self.handles and t.word[j - 1] in (">", "&") and t.at(j + 1) != "["
        return False

    def trailing_type(self, i):
        """-> of a lambda or of a function declared auto."""
        t, j = self.t, i - 1
        while t.at(j) in ("mutable", "noexcept", "const"):
            j -= 1
        if t.at(j) != ")":
            return False
        j = t.match.get(j, 0)
        return t.at(j - 1) in ("]", ">") or t.at(j - 2) == "auto"

    def inside_call(self, i, *names):
        depth = 0
        while i > 0 and self.t.word[i] not in (";", "{", "}"):
            depth += (self.t.word[i] == "(") - (self.t.word[i] == ")")
            if depth > 0 and self.t.word[i - 1] in names:
                return True
            i -= 1
        return False

    def is_definition(self, i):
        """A name that follows a type and whose brackets are followed by a body."""
        before = self.t.at(i - 1)
        return (is_name(before) and before not in ("return", "else", "do", "case")) or before in (">", "&")

    def loop(self, i):
        t, end = self.t, self.t.match.get(i + 1, i + 1)
        parts = t.split(i + 2, end, ";")
        if t.word[i] == "for" and len(parts) < 3 and ":" in t.word[i + 2:end]:
            return # over an array of registers
        if t.word[i] == "for":
            if len(parts) < 2:
                return
            begin, end = parts[1]
        else:
            begin = i + 2
        condition = t.word[begin:end]
        if "branch" in condition:
            return
        if not condition or condition in (["true"],):
            body = t.match.get(t.match.get(i + 1, i) + 1, i)
            if "branch" not in t.word[i:body]:
                self.report(i, "loop", "an endless loop without a branch() to leave it")
        elif not self.constant(begin, end):
            self.report(i, "loop", f"`{' '.join(condition)}` is neither constant nor branch(): {t.word[i]} (...; branch(...); ...)")

    # --- full expressions
    def expressions(self):
        t, start, i, controls = self.t, 0, 0, set()
        while i < len(t.word):
            w = t.word[i]
            if w in ("if", "while", "for", "switch"):
                opened = i + 1 + (t.at(i + 1) == "constexpr")
                controls.add(t.match.get(opened, -1))
                i = start = opened + 1
                continue
            if w == "{" and not self.is_initializer(i): # what stands before is a head, or a lambda's
                start = i + 1
            elif w == "{":
                i = t.match.get(i, i)
            elif w in (";", "}") or i in controls:
                self.expression(start, i)
                start = i + 1
            i += 1

    def is_initializer(self, i):
        before = self.t.at(i - 1)
        return before in ("=", ",", "(", "return", "{", "[", ":") or (is_name(before) and before not in KEYWORDS and
               before not in ("try", "mutable", "noexcept") and not self.opens_scope(i))

    def opens_scope(self, i):
        j = i - 1
        while j >= 0 and self.t.word[j] not in (";", "{", "}", ")"):
            if self.t.word[j] in ("struct", "class", "enum", "namespace", "union", "->"):
                return True
            j -= 1
        return False

    def expression(self, begin, end):
        t = self.t
        if begin >= end or t.word[begin] in ("using", "template", "namespace", "struct", "enum", "static_assert"):
            return
        if re.search(r"\w [(](?:.* , )?const [\w: <>]+ &", " ".join(t.word[begin:end])):
            return # a function declared
        pieces = [(begin, end)]
        declaration = t.word[begin] in TYPES | {"const", "auto", "int", "svec", "vvec"}
        if declaration: # each declared name has a full expression of its own
            pieces = t.split(begin, end)
        for b, e in pieces:
            accesses = [i for i in range(b, e) if t.word[i] in ACCESSES and t.at(i + 1) == "(" and
                        t.at(i - 1) not in (".", "->", "::") and not self.is_definition(i)]
            accesses = [i for i in accesses if not self.in_lambda(b, i)]
            for i in accesses[1:]:
                self.report(i, "one-access", f"{t.word[i]}() beside {t.word[accesses[0]]}() in one expression")
            if any(t.word[i] == "branch" for i in accesses):
                for i in range(b, e):
                    if t.word[i] in ("||", "&&"):
                        self.report(i, "control", f"{t.word[i]} beside branch() hides a branch: use & and | on sbool inside")
            self.computes(b, e)

    def in_lambda(self, begin, i):
        return any(self.t.word[j] == "{" and self.t.match.get(j, 0) > i for j in range(begin, i))

    def computes(self, begin, end):
        """Whether evaluating [begin, end) takes vocabulary operations; reports unordered pairs of such operands."""
        t = self.t
        while begin < end and (t.word[begin] in ("return", "const", "auto", "else") or t.word[begin] == "("
                               and t.match.get(begin) == end - 1):
            if t.word[begin] == "(":
                end -= 1
            begin += 1
        if begin >= end:
            return False
        for separator in (";", "=", "?", ":", "&&", "||", "<<", ","): # ordered by the language, or alternatives
            parts = t.split(begin, end, separator)
            if len(parts) > 1:
                timed = [self.computes(b, e) for b, e in parts]
                return any(timed) or (separator == "<<" and not self.constant(begin, end))
        for b, e in self.compound_assignments(begin, end):
            return self.computes(b, e) or not self.constant(begin, end)
        if self.folded_address(begin, end):
            return False
        for operators in reversed(PRECEDENCE):
            cuts = self.binary(begin, end, operators)
            if cuts:
                edges = [begin - 1, *cuts, end]
                operands = [(a + 1, b) for a, b in zip(edges, edges[1:])]
                timed = [self.computes(b, e) for b, e in operands]
                so_far, varies = timed[0], not self.constant(*operands[0])
                for cut, later, (b, e) in zip(cuts, timed[1:], operands[1:]):
                    if so_far and later:
                        self.report(cut, "one-operand", f"both sides of `{t.word[cut]}` compute: name one of them first")
                    varies = varies or not self.constant(b, e)
                    so_far = so_far or later or varies # a - b is itself an operand of what follows
                return any(timed) or varies
        if t.word[begin] in ("-", "!", "~", "++", "--") or t.word[end - 1] in ("++", "--"):
            self.computes(begin + 1, end)
            return not self.constant(begin, end)
        return self.calls_in(begin, end)

    def folded_address(self, begin, end):
        """handle + constant, which every access folds into its address."""
        parts = self.t.split(begin, end, "+")
        return len(parts) > 1 and self.t.word[parts[0][1] - 1] in self.handles and \
            all(is_name(w) or w in (".", "->") for w in self.t.word[begin:parts[0][1]]) and \
            all(self.constant(*part) for part in parts[1:])

    def compound_assignments(self, begin, end):
        for w in ("+=", "-=", "*=", "/=", "%=", "&=", "|=", "^="):
            parts = self.t.split(begin, end, w)
            if len(parts) > 1:
                return [parts[1]]
        return []

    def binary(self, begin, end, operators):
        t, cuts, i = self.t, [], begin
        while i < end:
            if t.word[i] in CLOSING:
                i = t.match.get(i, end)
            elif t.word[i] == "<" and self.template_end(i):
                i = self.template_end(i)
            elif t.word[i] in operators and i > begin and i + 1 < end:
                before = t.word[i - 1]
                if ">" in (t.at(i + 1), before) and t.word[i] == ">": # a shift, whose sides are ordered
                    i += 1
                elif is_name(before) and before not in KEYWORDS or before in (")", "]", "}", ">") or before[0].isdigit():
                    if not (t.word[i] in ("*", "&") and before in TYPES | self.type_names()):
                        cuts.append(i)
            i += 1
        return cuts

    def type_names(self):
        return {"float", "int", "auto", "T", "Context", "Group", "View"}

    def template_end(self, i):
        """The > of a template argument list that opens at i, if one does."""
        t, j, depth = self.t, i, 0
        if not is_name(t.at(i - 1)):
            return 0
        while j < len(t.word) and (is_name(t.word[j]) or t.word[j] in ("<", ">", "::", ",", "*", "&") or t.word[j].isdigit()):
            depth += (t.word[j] == "<") - (t.word[j] == ">")
            if depth == 0:
                return j if t.at(j + 1) in ("(", "{", "::") or (is_name(t.at(j + 1)) and t.at(j + 2) in ("(", "{", ";", "=")) or t.at(i - 1) in ("pointer", "ref", "shared") else 0
            j += 1
        return 0

    def calls_in(self, begin, end):
        t, timed, i = self.t, False, begin
        while i < end:
            if t.word[i] in ("(", "{", "["):
                close = t.match.get(i, end)
                name = t.at(i - 1)
                if name == ">":
                    j = i - 1
                    while j > begin and t.word[j] != "<":
                        j -= 1
                    name = t.at(j - 1)
                if t.word[i] == "[" or "{" in t.word[i + 1:close]: # a subscript, or a lambda somewhere inside
                    i = close + 1
                    continue
                arguments = t.split(i + 1, close)
                computing = [a for a in arguments if self.computes(*a)]
                if len(computing) > 1 and t.word[i] == "(":
                    self.report(computing[1][0], "one-operand", f"two arguments of {name}() compute: name one of them first")
                if computing:
                    timed = True
                elif is_name(name) and i > begin and t.word[i] == "(" and name not in FREE_CALLS:
                    timed = timed or name not in CONVERSIONS | {"F"} or not all(self.constant(*a) for a in arguments)
                i = close
            i += 1
        return timed

    # --- functions
    def functions(self):
        t, i = self.t, 0
        while i < len(t.word) - 1:
            if is_name(t.word[i]) and t.word[i] not in KEYWORDS and t.word[i + 1] == "(" and self.is_definition(i) and \
                    t.at(t.match.get(i + 1, -2) + 1) == "{":
                close = t.match[i + 1]
                arity = len(t.split(i + 2, close))
                body_end = t.match.get(close + 1, close + 1)
                key = (t.word[i], arity)
                self.defined.setdefault(key, (self.path, t.line[i], self.allowed))
                called = self.calls.setdefault(key, set())
                for j in range(close + 2, body_end):
                    if is_name(t.word[j]) and t.at(j + 1) == "(" and t.at(j - 1) not in (".", "->") and t.word[j] not in KEYWORDS:
                        called.add((t.word[j], len(t.split(j + 2, t.match.get(j + 1, j + 2)))))
                i = close
            i += 1

    def recursion(self):
        def reaches(start):
            seen, pending = set(), list(self.calls[start])
            while pending:
                k = pending.pop()
                if k in self.calls and k not in seen:
                    seen.add(k)
                    pending.extend(self.calls[k])
            return start in seen
        for key, (path, line, allowed) in self.defined.items():
            if key[0] not in OVERLOADED and reaches(key) and "recursion" not in allowed.get(line, ()):
                self.found.append((path, line, "recursion", f"{key[0]}() may call itself: use a stack in scratch memory"))


if __name__ == "__main__":
    names = sys.argv[1:]
    cut = names.index("--constants") if "--constants" in names else len(names)
    sys.exit(Lint(names[:cut], names[cut + 1:]).run())
