"""Finds the possible mutations of a C++ source, with libclang.

A mutation replaces the bytes [start, end) of a source. Code that the compiler evaluates is omitted: template arguments,
case labels, static_assert, array sizes, enumerators, `if constexpr`, consteval functions. A constexpr variable can be
mutated if its users accept one that is initialized at run time; `constexpr_at` is the position of its keyword.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import clang.cindex
from clang.cindex import Cursor, CursorKind, TranslationUnit

# How a mutation is written into the source; forms at the same place are nested in this order.
RETURN, STATEMENT, CONDITION, EXPRESSION = "return", "statement", "condition", "expression"
FORMS = (RETURN, STATEMENT, CONDITION, EXPRESSION)

COMPARISONS = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
}
LOGICAL = {"&&": ("||",), "||": ("&&",)}
ARITHMETIC = {
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("*",),
    "&": ("|",), "|": ("&",), "^": ("|",), "<<": (">>",), ">>": ("<<",),
}
ASSIGNMENTS = {f"{operator}=": (f"{others[0]}=",) for operator, others in ARITHMETIC.items()}
OPERATORS = {
    **{operator: ("comparison", others) for operator, others in COMPARISONS.items()},
    **{operator: ("logical operator", others) for operator, others in LOGICAL.items()},
    **{operator: ("arithmetic operator", others) for operator, others in {**ARITHMETIC, **ASSIGNMENTS}.items()},
}

INTEGER = re.compile(rb"(0[xX][0-9a-fA-F']+|0[bB][01']+|[0-9][0-9']*)([uUlLzZ]*)")
# The argument of a macro is not always an expression. Recording all macros would take longer than everything else.
MACRO_CALL = re.compile(rb"\b(?:[A-Z][A-Z0-9_]{2,}|assert)\(")
# Values that `return {};` also returns.
EMPTY_VALUES = {b"{}", b"false", b"nullptr", b"0", b"0U", b"std::nullopt", b'""'}

CONSTANT_KINDS = {
    CursorKind.STATIC_ASSERT, CursorKind.ENUM_CONSTANT_DECL, CursorKind.TEMPLATE_TYPE_PARAMETER,
    CursorKind.TEMPLATE_NON_TYPE_PARAMETER, CursorKind.TEMPLATE_TEMPLATE_PARAMETER, CursorKind.TYPE_ALIAS_DECL,
    CursorKind.TYPEDEF_DECL, CursorKind.TYPE_ALIAS_TEMPLATE_DECL, CursorKind.TYPE_REF, CursorKind.TEMPLATE_REF,
}
NAMES = {CursorKind.DECL_REF_EXPR, CursorKind.MEMBER_REF_EXPR}
FUNCTIONS = {
    CursorKind.FUNCTION_DECL, CursorKind.CXX_METHOD, CursorKind.CONSTRUCTOR, CursorKind.DESTRUCTOR,
    CursorKind.CONVERSION_FUNCTION, CursorKind.FUNCTION_TEMPLATE,
}
CLASSES = {
    CursorKind.CLASS_DECL, CursorKind.STRUCT_DECL, CursorKind.CLASS_TEMPLATE,
    CursorKind.CLASS_TEMPLATE_PARTIAL_SPECIALIZATION,
}
VARIABLES = {CursorKind.VAR_DECL, CursorKind.FIELD_DECL}


@dataclass(frozen=True)
class Mutation:
    file: str
    line: int
    operator: str
    form: str
    start: int
    end: int
    text: bytes  # replacement of the bytes; for a condition, the new condition
    in_constexpr: bool = False  # perhaps evaluated only by the compiler
    constexpr_at: int | None = None  # keyword of the enclosing variable
    constexpr_becomes: bytes = b""

    def apply(self, source: bytes) -> bytes:
        return source[: self.start] + self.text + source[self.end :]

    def changed_line(self, source: bytes) -> tuple[str, str]:
        """Returns the first line that differs, before and after."""
        before, after = source.decode().splitlines(), self.apply(source).decode().splitlines()
        for old, new in zip(before, after):
            if old != new:
                return old.strip(), new.strip()
        return "", ""


@dataclass(frozen=True)
class Context:
    in_constexpr: bool = False
    in_function: bool = False
    in_class: bool = False
    constexpr_at: int | None = None
    constexpr_becomes: bytes = b""


class Finder:
    def __init__(self, file: str, source: bytes, unit: TranslationUnit, constexpr_variables: bool):
        self.file = file
        self.source = source
        self.constexpr_variables = constexpr_variables
        self.found: dict[tuple, Mutation] = {}
        self.path = unit.spelling
        self.macros = [(match.start(), self.closing_parenthesis(match.end())) for match in MACRO_CALL.finditer(source)]
        for cursor in unit.cursor.get_children():
            if self.is_here(cursor):
                self.visit(cursor, Context())

    def is_here(self, cursor: Cursor) -> bool:
        return cursor.location.file is not None and cursor.location.file.name == self.path

    def closing_parenthesis(self, start: int) -> int:
        """Returns the end of the text after an opening parenthesis."""
        depth = 1
        for at in range(start, len(self.source)):
            depth += {b"(": 1, b")": -1}.get(self.source[at : at + 1], 0)
            if depth == 0:
                return at + 1
        return len(self.source)

    def text(self, cursor: Cursor) -> bytes:
        return self.source[cursor.extent.start.offset : cursor.extent.end.offset]

    def add(self, cursor: Cursor, context: Context, operator: str, form: str, text: bytes) -> None:
        start, end = cursor.extent.start.offset, cursor.extent.end.offset
        original = self.source[start:end]
        if start >= end or b"//" in original or b"#" in original:
            return
        if any(start < macro_end and macro_start < end for macro_start, macro_end in self.macros):
            return
        mutation = Mutation(self.file, cursor.extent.start.line, operator, form, start, end, text, context.in_constexpr,
                            context.constexpr_at, context.constexpr_becomes)
        self.found.setdefault((start, end, form, text), mutation)

    # ---- walk ----

    def visit(self, cursor: Cursor, context: Context) -> None:
        kind = cursor.kind
        if kind in CONSTANT_KINDS or self.text(cursor).startswith(b"requires"):
            return
        if kind in FUNCTIONS or kind == CursorKind.LAMBDA_EXPR:
            specifiers = self.source[cursor.extent.start.offset : cursor.location.offset]
            if b"consteval" in specifiers:
                return
            context = Context(context.in_constexpr or b"constexpr" in specifiers, True, False)
        elif kind in CLASSES:
            context = Context(context.in_constexpr, False, True)
        elif kind in VARIABLES:
            variable = self.variable_context(cursor, context)
            if variable is None:
                return
            context = variable
        children = list(cursor.get_children())
        self.add_mutations(cursor, children, context)
        for child in self.run_time_children(cursor, children):
            self.visit(child, context)

    def variable_context(self, cursor: Cursor, context: Context) -> Context | None:
        """Returns the context of the initializer of a variable, or None if the compiler evaluates it."""
        start = cursor.extent.start.offset
        specifiers = self.source[start : cursor.location.offset]
        if b"constinit" in specifiers or cursor.is_bitfield():
            return None
        keyword = re.search(rb"\bconstexpr\b", specifiers)
        if keyword is None:
            return context
        if not self.constexpr_variables:
            return None
        becomes = b"inline const" if context.in_class and b"inline" not in specifiers else b"const"
        return Context(context.in_constexpr, context.in_function, context.in_class, start + keyword.start(), becomes)

    def run_time_children(self, cursor: Cursor, children: list[Cursor]) -> list[Cursor]:
        """Returns the children without those that the compiler evaluates."""
        kind = cursor.kind
        if kind == CursorKind.CASE_STMT:
            return children[1:]
        if kind == CursorKind.IF_STMT and re.match(rb"if\s+constexpr", self.text(cursor)):
            condition = self.condition_of(cursor, children)
            return [child for child in children if child != condition]
        if kind in NAMES:  # literals are template arguments
            return [child for child in children if child.kind != CursorKind.INTEGER_LITERAL]
        if kind in VARIABLES:  # what precedes the name or a ] belongs to the type
            return [
                child for child in children
                if child.extent.start.offset > cursor.location.offset
                and not self.source[child.extent.end.offset :].lstrip().startswith(b"]")
            ]
        return [child for child in children if not self.is_template_argument(child)]

    def is_template_argument(self, cursor: Cursor) -> bool:
        if cursor.kind != CursorKind.INTEGER_LITERAL:
            return False
        before = self.source[: cursor.extent.start.offset].rstrip()
        return re.search(rb"[A-Za-z_]<$", before) is not None

    # ---- operators ----

    def add_mutations(self, cursor: Cursor, children: list[Cursor], context: Context) -> None:
        kind = cursor.kind
        if kind in (CursorKind.BINARY_OPERATOR, CursorKind.COMPOUND_ASSIGNMENT_OPERATOR):
            self.exchange_operator(cursor, children, context)
        elif kind == CursorKind.CALL_EXPR and cursor.spelling.startswith("operator") and len(children) == 3:
            self.exchange_operator(cursor, [children[0], children[2]], context)
        elif kind == CursorKind.INTEGER_LITERAL:
            self.change_constant(cursor, context)
        elif kind == CursorKind.CXX_BOOL_LITERAL_EXPR:
            self.add(cursor, context, "constant", EXPRESSION, b"false" if self.text(cursor) == b"true" else b"true")
        elif kind == CursorKind.RETURN_STMT and children:
            if self.text(children[0]).strip() not in EMPTY_VALUES:
                self.add(cursor, context, "dropped return value", RETURN, b"return {}")
        elif kind in (CursorKind.IF_STMT, CursorKind.WHILE_STMT):
            if not re.match(rb"if\s+constexpr", self.text(cursor)):
                self.negate(self.condition_of(cursor, children), context)
        elif kind == CursorKind.CONDITIONAL_OPERATOR:
            self.negate(children[0], context)
        if kind == CursorKind.COMPOUND_STMT:
            self.drop_statements(children, context)
        elif kind in (CursorKind.CASE_STMT, CursorKind.DEFAULT_STMT):
            self.drop_statements(children[-1:], context)

    def exchange_operator(self, cursor: Cursor, operands: list[Cursor], context: Context) -> None:
        if len(operands) != 2:
            return
        left, right = operands
        first, last = left.extent.end.offset, right.extent.start.offset
        operator = self.source[first:last].strip().decode()
        # libclang can report an operand in parentheses or of a dependent type without its complete text.
        if operator not in OPERATORS or left.extent.start.offset != cursor.extent.start.offset:
            return
        name, others = OPERATORS[operator]
        for other in others:
            between = self.source[first:last].replace(operator.encode(), other.encode(), 1)
            text = self.source[cursor.extent.start.offset : first] + between + \
                self.source[last : cursor.extent.end.offset]
            self.add(cursor, context, f"{name} {operator} -> {other}", EXPRESSION, text)

    def change_constant(self, cursor: Cursor, context: Context) -> None:
        literal = self.text(cursor)
        match = INTEGER.fullmatch(literal)
        if match is None:
            return
        digits, suffix = match.groups()
        digits = digits.replace(b"'", b"")
        is_octal = len(digits) > 1 and digits.isdigit() and digits.startswith(b"0")
        number = int(digits, 8 if is_octal else 0)
        is_hexadecimal = digits[:2] in (b"0x", b"0X")
        for changed in (number + 1, number - 1):
            if changed >= 0:
                text = (f"0x{changed:X}" if is_hexadecimal else str(changed)).encode() + suffix
                self.add(cursor, context, f"constant {literal.decode()} -> {text.decode()}", EXPRESSION, text)

    def condition_of(self, cursor: Cursor, children: list[Cursor]) -> Cursor | None:
        """Returns the condition of an `if` or `while`, or None if it declares a variable."""
        depth, end = 0, None
        for token in cursor.get_tokens():
            depth += {"(": 1, ")": -1}.get(token.spelling, 0)
            if token.spelling == ")" and depth == 0:
                end = token.extent.start.offset
                break
        inside = [child for child in children if end is not None and child.extent.end.offset <= end]
        if not inside or any(child.kind == CursorKind.VAR_DECL for child in inside):
            return None
        return inside[-1] if inside[-1].kind.is_expression() else None

    def negate(self, condition: Cursor | None, context: Context) -> None:
        if condition is None:
            return
        text = self.text(condition)
        children = list(condition.get_children())
        if condition.kind == CursorKind.BINARY_OPERATOR and len(children) == 2:
            between = self.source[children[0].extent.end.offset : children[1].extent.start.offset].strip().decode()
            if between in ("==", "!="):
                return  # the exchanged comparison is the same
        self.add(condition, context, "negated condition", CONDITION, b"!(" + text + b")")

    def drop_statements(self, statements: list[Cursor], context: Context) -> None:
        for statement in statements:
            if statement.kind.is_expression() and not re.match(rb"static_cast<void>|\(void\)", self.text(statement)):
                self.add(statement, context, "dropped statement", STATEMENT, b"")


def find_mutations(root: Path, file: str, arguments: list[str], constexpr_variables: bool) -> list[Mutation]:
    """Returns the mutations of root/file, compiled with `arguments`, in the order of the source."""
    path = root / file
    unit = clang.cindex.Index.create().parse(str(path), args=["-xc++", *arguments])
    errors = [text for text in unit.diagnostics if text.severity >= clang.cindex.Diagnostic.Fatal]
    if errors:
        raise RuntimeError(f"{file}: {errors[0].spelling}")
    finder = Finder(file, path.read_bytes(), unit, constexpr_variables)
    return sorted(finder.found.values(), key=lambda mutation: (mutation.start, mutation.end, mutation.text))
