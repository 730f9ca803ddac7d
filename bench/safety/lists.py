#!/usr/bin/env python3
"""Lists from the code of the runtime that a reviewer of docs/safety.md needs. Host code (host/), simulation and
plants (canopen_sim/, canopen_plant/) are not included.

    lists.py casts RUNTIME           reinterpret_cast, const_cast and offsetof, by file
    lists.py copies RUNTIME          memcpy, memmove, memcmp and memset, by file
    lists.py loops RUNTIME           the loops that are neither range-based nor counted, with their bounds of loops.tsv
    lists.py cycles RUNTIME EDSC     the cycles of calls of the program in parts.cpp

RUNTIME is runtime/include/canopen. Sources are read as tokens, without comments and literals. A counted loop is a `for` whose
variable is compared with a bound, is changed only by the header, as is the bound, and moves in one direction. GCC writes the
graph of calls, without inlining; functions of the standard library and lambdas are ignored of the names of a cycle.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
sys.path.insert(0, str(HERE.parent / "footprint"))
from stack import CallGraph  # noqa: E402

COMPILER = ("arm-none-eabi-g++", "-std=c++20", "-mthumb", "-mcpu=cortex-m0plus", "-O0", "-fno-exceptions", "-fno-rtti",
            "-fno-threadsafe-statics", "-Wall", "-Wextra", "--specs=nano.specs")
CASTS = ("reinterpret_cast", "const_cast", "offsetof")
COPIES = ("memcpy", "memmove", "memcmp", "memset")
TOKEN = re.compile(r"""
    (?P<skip> \s+ | //[^\n]* | /\*.*?\*/ | \\\n )
  | (?P<literal> "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])+' )
  | (?P<word> [A-Za-z_]\w* )
  | (?P<number> \.?\d(?:'?[\w.])* )
  | (?P<operator> <=> | <<= | >>= | \.\.\. | ->\* | \+\+ | -- | -> | :: | << | <= | >= | == | != | && | \|\| | [-+*/%&|^]= | . )
""", re.VERBOSE | re.DOTALL)
PAIRS = {"(": ")", "[": "]", "{": "}"}
STEPS = ("++", "--", "+=", "-=")
CHANGES = (*STEPS, "=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>=")
COMPARISONS = ("<", "<=", ">", ">=", "!=")


class Token(str):
    """A token, and the space and comments before it."""

    space: bool


def tokens_of(text: str) -> list[Token]:
    tokens, space = [], False
    for match in TOKEN.finditer(text):
        if match.lastgroup == "skip":
            space = True
            continue
        token = Token(match[0])
        token.space, space = space, False
        if token in ("R", "LR", "u8R") and text[match.end():match.end() + 1] == '"':
            raise ValueError("a raw string literal: this program does not read it")
        tokens.append(token)
    return tokens


def sources(runtime: Path) -> list[Path]:
    return [path for path in sorted(runtime.rglob("*.hpp")) if path.relative_to(runtime).parts[0] != "host"]


def end_of(tokens: list[Token], begin: int) -> int:
    """Returns the position after the bracket that closes the one at `begin`."""
    closing = [PAIRS[tokens[begin]]]
    at = begin + 1
    while closing:
        if tokens[at] in PAIRS:
            closing.append(PAIRS[tokens[at]])
        elif tokens[at] == closing[-1]:
            closing.pop()
        at += 1
    return at


def split(tokens: list[Token], separator: str) -> list[list[Token]]:
    """Splits at a token that is not inside of brackets."""
    parts: list[list[Token]] = [[]]
    at = 0
    while at < len(tokens):
        end = end_of(tokens, at) if tokens[at] in PAIRS else at + 1
        if tokens[at] == separator:
            parts.append([])
        else:
            parts[-1] += tokens[at:end]
        at = end
    return parts


def statement_end(tokens: list[Token], begin: int) -> int:
    """Returns the position after the statement that begins at `begin`."""
    if tokens[begin] == "{":
        return end_of(tokens, begin)
    at = begin
    if tokens[at] in ("for", "while", "if", "switch"):
        while tokens[at] != "(":
            at += 1
        at = statement_end(tokens, end_of(tokens, at))
        return statement_end(tokens, at + 1) if tokens[begin] == "if" and tokens[at] == "else" else at
    while tokens[at] != ";":
        at = end_of(tokens, at) if tokens[at] in PAIRS else at + 1
    return at + 1


def changed_in(tokens: list[Token]) -> set[str]:
    """Returns the words that are assigned, incremented or decremented."""
    changed = set()
    for i, token in enumerate(tokens):
        through_pointer = i > 1 and token not in ("++", "--") and tokens[i - 2] == "*"
        if token in CHANGES and i > 0 and not through_pointer:
            changed.add(tokens[i - 1])
        if token in ("++", "--") and i + 1 < len(tokens):
            changed.add(tokens[i + 1])
    return changed


def is_counted(header: list[Token], body: list[Token]) -> bool:
    parts = split(header, ";")
    if len(parts) != 3 or "||" in parts[1]:
        return False
    stepped = changed_in(parts[2])
    for part in split(parts[1], "&&"):
        if part[1:2] == ["--"] and part[2:] in ([">", "0"], ["!=", "0"]) and part[0] not in stepped | changed_in(body):
            return True
        place = next((i for i, token in enumerate(part) if token in COMPARISONS), None)
        if place is None:
            continue
        for variable, bound in ((part[:place], part[place + 1:]), (part[place + 1:], part[:place])):
            words = {token for token in bound if token[0].isalpha() or token[0] == "_"}
            is_number = "(" not in without_sizes(bound)
            is_sum = len(variable) == 3 and variable[1] == "+" and variable[2][0].isdigit()
            counts = (len(variable) == 1 or is_sum) and variable[0] in stepped
            if counts and is_number and not (words | {variable[0]}) & changed_in(body) and not words & stepped:
                return True
    return False


def without_sizes(bound: list[Token]) -> list[Token]:
    """Removes brackets that are not of calls, except for calls of size."""
    return [token for i, token in enumerate(bound)
            if token != "(" or i > 0 and bound[i - 1] != "size" and re.match(r"[\w)\]]", bound[i - 1])]


def text_of(tokens: list[Token]) -> str:
    return "".join(" " * token.space + token for token in tokens).strip()


@dataclass
class Loop:
    file: str
    text: str
    kind: str  # range, counted or other


def loops_of(name: str, tokens: list[Token]) -> list[Loop]:
    found = []
    do_ends = set()  # the `while` of a `do`
    for i, token in enumerate(tokens):
        if token == "do":
            end = statement_end(tokens, i + 1)
            do_ends.add(end)
            found.append(Loop(name, f"do ... while ({text_of(tokens[end + 2:end_of(tokens, end + 1) - 1])})", "other"))
        elif token == "while" and i not in do_ends:
            end = end_of(tokens, i + 1)
            found.append(Loop(name, f"while ({text_of(tokens[i + 2:end - 1])})", "other"))
        elif token == "for":
            end = end_of(tokens, i + 1)
            header = tokens[i + 2:end - 1]
            body = tokens[end:statement_end(tokens, end)]
            ranged = len(split(header, ":")) == 2 and len(split(header, ";")) < 3
            kind = "range" if ranged else "counted" if is_counted(header, body) else "other"
            found.append(Loop(name, f"for ({text_of(header)})", kind))
    return found


def count(runtime: Path, words: tuple[str, ...]) -> None:
    totals: Counter[str] = Counter()
    for path in sources(runtime):
        counts = Counter(token for token in tokens_of(path.read_text(encoding="utf-8")) if token in words)
        totals += counts
        if counts:
            print(f"{path.relative_to(runtime).as_posix():34} " + ", ".join(f"{counts[word]} {word}" for word in words if counts[word]))
    print(f"{'all':34} " + ", ".join(f"{totals[word]} {word}" for word in words))


def print_loops(runtime: Path) -> int:
    rows = [line.split("\t") for line in (HERE / "loops.tsv").read_text(encoding="utf-8").splitlines()]
    bounds = {(file, text): bound for file, text, bound in rows}
    loops = [loop for path in sources(runtime)
             for loop in loops_of(path.relative_to(runtime).as_posix(), tokens_of(path.read_text(encoding="utf-8")))]
    kinds = Counter(loop.kind for loop in loops)
    others = Counter((loop.file, loop.text) for loop in loops if loop.kind == "other")
    print(f"{kinds['range']} range-based loops, {kinds['counted']} counted loops, {kinds['other']} others:")
    for (file, text), number in others.items():
        print(f"{file}: {text}{f' ({number} times)' if number > 1 else ''}")
        print(f"    {bounds.get((file, text), 'no bound in bench/safety/loops.tsv')}")
    unknown = [f"{file} does not have the loop {text}" for file, text in bounds if (file, text) not in others]
    print("".join(f"bench/safety/loops.tsv: {line}\n" for line in unknown), end="")
    return 1 if unknown or others.keys() - bounds.keys() else 0


def short_name(label: str) -> str:
    """Returns `Node::serve` of `void canopen::Node<Device, B, Parts>::serve() [with ...]`; empty: not a name to print."""
    name = label.split("\\n")[0].split(" [with ")[0].replace("{anonymous}::", "").removesuffix(" const")
    if name.startswith(")") or "<lambda" in name:
        return ""
    name = re.sub(r"operator\W+\(", "operator(", name)
    kept, depth = "", 0
    for character in name:
        depth += character in "<(["
        if depth == 0:
            kept += character
        depth -= character in ">)]"
    words = kept.split()
    short = words[-1].removeprefix("canopen::") if words else ""
    plumbing = r"std::|__|\w*handler_detail|HandlerSet\b|HandlerCalls?\b|ObjectList\b|_"
    return "" if re.match(plumbing, short) else short


def call_graphs(runtime: Path, edsc: Path, *variants: list[str]) -> list[CallGraph]:
    """Returns the graphs of parts.cpp with these flags."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for sheet in ("tests/fixtures/every_service.eds", "eds/cpc-tc1.eds"):
            subprocess.run([edsc, "generate", SOURCE / sheet, "-o", folder], check=True, stderr=subprocess.DEVNULL)
        compilers = [subprocess.Popen([*COMPILER, "-fcallgraph-info", *flags, f"-I{runtime.parent.resolve()}", f"-I{folder}", "-c",
                                       HERE / "parts.cpp", "-o", folder / f"{i}.o"]) for i, flags in enumerate(variants)]
        if any([compiler.wait() != 0 for compiler in compilers]):
            sys.exit("parts.cpp does not compile")
        return [CallGraph((folder / f"{i}.ci").read_text()) for i in range(len(variants))]


def cycles(graph: CallGraph) -> set[tuple[str, ...]]:
    """Returns the cycles by the names of their functions."""
    names = {function: name for function in graph.calls if (name := short_name(graph.labels.get(function, function)))}
    calls: dict[str, set[str]] = {}
    for function in names:
        calls[function], waiting, seen = set(), [function], {function}
        while waiting:
            for callee in graph.calls.get(waiting.pop(), ()):
                if callee in names:
                    calls[function].add(callee)
                elif callee not in seen:
                    seen.add(callee)
                    waiting.append(callee)
    found = set()
    for cycle in elementary_cycles(calls):
        first = min(range(len(cycle)), key=lambda i: [names[name] for name in cycle[i:] + cycle[:i]])
        found.add(tuple(names[name] for name in cycle[first:] + cycle[:first]))
    return found


def elementary_cycles(calls: dict[str, set[str]]) -> list[tuple[str, ...]]:
    callers: dict[str, set[str]] = {}
    for caller, callees in calls.items():
        for callee in callees:
            callers.setdefault(callee, set()).add(caller)
    found = []
    for first in sorted(calls):
        reaching, waiting = set(), [first]
        while waiting:
            new = {caller for caller in callers.get(waiting.pop(), ()) if caller >= first} - reaching
            reaching |= new
            waiting += new
        stack = [(first, (first,))] if first in reaching else []
        while stack:
            function, path = stack.pop()
            if first in calls[function]:
                found.append(path)
            stack += [(callee, (*path, callee)) for callee in calls[function] & reaching if callee > first and callee not in path]
    return found


def print_cycles(runtime: Path, edsc: Path) -> None:
    graphs = call_graphs(runtime, edsc, [], ["-DCALLS_NODE"])
    own, with_application = map(cycles, graphs)
    print(f"{len(own)} cycles of the runtime:")
    for cycle in sorted(own):
        print("  " + " -> ".join((*cycle, cycle[0])))
    pairs = {pair for cycle in with_application for pair in zip(cycle, (*cycle[1:], cycle[0]))
             if pair[0].startswith("Application::")}
    print("functions of an application that calls the node, which the function of the node can call again:")
    for function, called in sorted(pairs):
        print(f"  {function} -> {called}")
    print("calls through a pointer, to which the graph ends:")
    for function in sorted({short_name(graphs[0].labels[caller]) for caller, callees in graphs[0].calls.items()
                            if "__indirect_call" in callees}):
        print(f"  {function}")


def main() -> int:
    what, runtime = sys.argv[1], Path(sys.argv[2])
    if what == "casts":
        count(runtime, CASTS)
    elif what == "copies":
        count(runtime, COPIES)
    elif what == "loops":
        return print_loops(runtime)
    elif what == "cycles":
        print_cycles(runtime, Path(sys.argv[3]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
