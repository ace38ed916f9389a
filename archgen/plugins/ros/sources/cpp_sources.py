"""Sources in C++ as source code for the walk, by the grammar of tree-sitter: without it no file of C++ is read."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from archgen.plugins.ros.sources.source_code import (
    MAX_DEPTH,
    Expression,
    ExpressionKind,
    Function,
    FunctionParameter,
    SourceClass,
    SourceFile,
    Statement,
)

if TYPE_CHECKING:
    from tree_sitter import Node, Parser

_MAX_TEXT = 80
_REGISTRATION = re.compile(r"\b(?:RCLCPP_COMPONENTS_REGISTER_NODE|PLUGINLIB_EXPORT_CLASS)\s*\(\s*([\w:]+)")
_ESCAPES = {"n": "\n", "t": "\t", "0": "\0"}
_TYPES_LEFT_OUT = re.compile(r"\b(?:const|constexpr|static|inline|struct|class|typename|volatile|mutable)\b|[&*\s]")
_BLOCKS = frozenset(
    {
        *("declaration_list", "linkage_specification", "preproc_ifdef", "preproc_if", "preproc_else", "preproc_elif"),
        *("field_declaration_list", "translation_unit", "ERROR"),
    }
)
_CLASSES = frozenset({"class_specifier", "struct_specifier"})
_IDENTITIES = frozenset(
    {"parenthesized_expression", "pointer_expression", "condition_clause", "parameter_pack_expansion"}
)


def make_cpp_parser() -> Parser | None:
    """Return a parser, None where tree-sitter is not installed."""
    try:
        import tree_sitter
        import tree_sitter_cpp
    except ImportError:
        return None
    return tree_sitter.Parser(tree_sitter.Language(tree_sitter_cpp.language()))


def read_cpp_source(parser: Parser, path: Path, shown: str, text: str) -> SourceFile:
    """Return a file."""
    file = SourceFile(path, shown, "cpp")
    file.plugins = tuple(_REGISTRATION.findall(text))
    tree = parser.parse(text.encode())
    reader = _Reader(file)
    reader.read_outside(tree.root_node, "", 0)
    file.statements, file.includes = tuple(reader.statements), tuple(reader.includes)
    return file


def _text(node: Node | None) -> str:
    return "" if node is None or node.text is None else node.text.decode("utf-8", "replace")


def clean_type(text: str) -> str:
    """Return the name of a type without what says how it is held."""
    return _TYPES_LEFT_OUT.sub("", text)


class _Reader:
    """Turns the tree of one file into source code."""

    def __init__(self, file: SourceFile) -> None:
        self._file = file
        self.statements: list[Statement] = []
        self.includes: list[str] = []

    def read_outside(  # noqa: C901, PLR0912 - one for each form
        self, block: Node, outer: str, depth: int, type_parameters: tuple[str, ...] = ()
    ) -> None:
        """Read what stands outside of functions; `outer` is the namespace around it, with `::` behind it."""
        for node in block.named_children if depth < MAX_DEPTH else ():
            kind = node.type
            if kind == "namespace_definition":
                name = _text(node.child_by_field_name("name"))
                body = node.child_by_field_name("body")
                if body is not None:
                    self.read_outside(body, f"{outer}{name}::" if name else outer, depth + 1)
            elif kind in _BLOCKS:
                self.read_outside(node, outer, depth + 1)
            elif kind == "template_declaration":
                self.read_outside(node, outer, depth + 1, _list_type_parameters(node))
            elif kind in _CLASSES:
                self._read_class(node, outer, depth, type_parameters)
            elif kind == "function_definition":
                self._add_function(node, outer, None, depth, type_parameters)
            elif kind == "declaration":
                inner = node.child_by_field_name("type")
                if inner is not None and inner.type in _CLASSES:
                    self._read_class(inner, outer, depth, type_parameters)
                self.statements += self._read_declaration(node, depth)
            elif kind in {"alias_declaration", "type_definition", "using_declaration"}:
                self._read_alias(node, self._file.aliases)
            elif kind == "preproc_include":
                self.includes.append(_text(node.child_by_field_name("path")).strip('<>" '))
            elif kind == "preproc_def":
                value = _text(node.child_by_field_name("value")).strip()
                if value.startswith('"') and value.endswith('"') and value.count('"') == 2:  # noqa: PLR2004 - one text
                    name = _text(node.child_by_field_name("name"))
                    target = self._make(node, "name", name)
                    self.statements.append(Statement("set", self._make(node, "value", value[1:-1]), (target,)))

    def _read_alias(self, node: Node, aliases: dict[str, str]) -> None:
        if node.type == "alias_declaration":
            aliases[_text(node.child_by_field_name("name"))] = clean_type(_text(node.child_by_field_name("type")))
        elif node.type == "type_definition":
            aliases[_text(node.child_by_field_name("declarator"))] = clean_type(_text(node.child_by_field_name("type")))
        elif node.named_children and not any(child.type == "namespace" for child in node.children):
            name = _text(node.named_children[-1])
            aliases[name.rpartition("::")[2]] = name

    def _read_class(self, node: Node, outer: str, depth: int, type_parameters: tuple[str, ...]) -> None:
        name, body = node.child_by_field_name("name"), node.child_by_field_name("body")
        if name is None or body is None:
            return
        bases = tuple(
            clean_type(_text(base))
            for clause in node.named_children
            if clause.type == "base_class_clause"
            for base in clause.named_children
            if base.type not in {"access_specifier", "virtual"}
        )
        found = SourceClass(f"{outer}{_text(name)}", self._file, bases, type_parameters=type_parameters)
        self._file.classes[found.name] = found
        self._read_members(body, found, depth + 1)

    def _read_members(  # noqa: C901 - one for each form
        self, body: Node, found: SourceClass, depth: int, type_parameters: tuple[str, ...] = ()
    ) -> None:
        for node in body.named_children if depth < MAX_DEPTH else ():
            kind = node.type
            if kind in _BLOCKS or kind == "template_declaration":
                self._read_members(node, found, depth + 1, _list_type_parameters(node))
            elif kind == "function_definition":
                self._add_function(node, "", found, depth, type_parameters)
            elif kind in {"alias_declaration", "type_definition", "using_declaration"}:
                self._read_alias(node, found.aliases)
            elif kind in _CLASSES:
                self._read_class(node, f"{found.name}::", depth, ())
            elif kind == "field_declaration":
                type_node = node.child_by_field_name("type")
                if type_node is not None and type_node.type in _CLASSES:
                    self._read_class(type_node, f"{found.name}::", depth, ())
                default = node.child_by_field_name("default_value")
                for declarator in node.children_by_field_name("declarator"):
                    name = _find_name(declarator)
                    if name and declarator.type != "function_declarator":
                        holds = "*" if declarator.type in {"pointer_declarator", "reference_declarator"} else ""
                        found.fields[name] = clean_type(_text(type_node)) + holds
                        if default is not None:
                            target = self._make(node, "name", name)
                            found.field_values.append(Statement("set", self._read(default, depth), (target,)))

    def _add_function(
        self, node: Node, outer: str, owner: SourceClass | None, depth: int, type_parameters: tuple[str, ...]
    ) -> None:
        declarator = _find_function(node.child_by_field_name("declarator"))
        if declarator is None:
            return
        full_name = re.sub(r"<[^<>]*>", "", "".join(_text(declarator.child_by_field_name("declarator")).split()))
        scope, _, name = full_name.rpartition("::")
        owner_name = owner.name if owner else f"{outer}{scope}" if scope else ""
        parameters = self._read_parameters(declarator.child_by_field_name("parameters"), depth)
        statements: list[Statement] = []
        for child in node.named_children:
            if child.type == "field_initializer_list":
                statements += self._read_initializers(child, depth)
        statements += self._read_block(node.child_by_field_name("body"), depth)
        function = Function(
            name,
            parameters,
            tuple(statements),
            self._file,
            owner_name,
            is_static=False,
            type_parameters=type_parameters,
        )
        if owner is not None:
            owner.functions.setdefault(name, []).append(function)
        else:
            self._file.functions.setdefault(f"{owner_name}::{name}" if owner_name else name, []).append(function)

    def _read_parameters(self, node: Node | None, depth: int) -> tuple[FunctionParameter, ...]:
        found: list[FunctionParameter] = []
        for child in node.named_children if node is not None else ():
            if child.type in {"parameter_declaration", "optional_parameter_declaration"}:
                default = child.child_by_field_name("default_value")
                text = _text(child)
                held = "&" if "&" in text and not text.lstrip().startswith("const") else ""
                found.append(
                    FunctionParameter(
                        _find_name(child.child_by_field_name("declarator")),
                        clean_type(_text(child.child_by_field_name("type"))) + held,
                        None if default is None else self._read(default, depth),
                    )
                )
        return tuple(found)

    def _read_initializers(self, node: Node, depth: int) -> Iterator[Statement]:
        for child in node.named_children:
            if child.type == "field_initializer" and child.named_children:
                name, *values = child.named_children
                arguments = [self._read(a, depth) for value in values for a in value.named_children]
                # Whether it is a member or a base is known when all of the class is.
                made = self._make(child, "call", None, (self._make(name, "name", clean_type(_text(name))), *arguments))
                yield Statement("local", made)

    def _read_block(self, node: Node | None, depth: int) -> tuple[Statement, ...]:
        if node is None or depth > MAX_DEPTH:
            return ()
        children = node.named_children if node.type in {"compound_statement", "case_statement"} else [node]
        return tuple(each for child in children for each in self._read_statement(child, depth + 1))

    def _read_statement(self, node: Node, depth: int) -> list[Statement]:  # noqa: C901, PLR0911 - one for each form
        kind = node.type
        if kind in {"compound_statement", "case_statement", "else_clause", "labeled_statement", "ERROR"}:
            return [each for child in node.named_children for each in self._read_block(child, depth)]
        if kind == "declaration":
            return self._read_declaration(node, depth)
        if kind == "expression_statement":
            return self._read_effect(node.named_children[0], depth) if node.named_children else []
        if kind == "if_statement":
            condition = node.child_by_field_name("condition")
            initial = [
                each
                for child in (condition.named_children if condition is not None else ())
                if child.type in {"declaration", "init_statement"}
                for each in self._read_declaration(child, depth)
            ]
            asked = self._read(condition, depth) if condition is not None else None
            consequence = self._read_block(node.child_by_field_name("consequence"), depth)
            alternative = self._read_block(node.child_by_field_name("alternative"), depth)
            return [*initial, Statement("branch", asked, (), consequence, alternative)]
        if kind == "for_range_loop":
            right, body = node.child_by_field_name("right"), node.child_by_field_name("body")
            name = _find_name(node.child_by_field_name("declarator"))
            if right is None or body is None:
                return []
            target = self._make(node, "name", name)
            return [Statement("loop", self._read(right, depth), (target,), self._read_block(body, depth))]
        if kind in {"for_statement", "while_statement", "do_statement", "switch_statement"}:
            start = node.child_by_field_name("initializer")
            unknown = self._make(node, "unknown")
            counter = _find_name(start.child_by_field_name("declarator")) if start is not None else ""
            before = [Statement("set", unknown, (self._make(node, "name", counter),))] if counter else []
            inner = self._read_block(node.child_by_field_name("body"), depth)
            return [*before, Statement("branch", unknown, body=inner)]
        if kind == "try_statement":
            tried, *handlers = (
                self._read_block(_find_body(child), depth) for child in [node, *node.named_children[1:]]
            )
            return [*tried, *(Statement("branch", self._make(node, "unknown"), body=each) for each in handlers)]
        if kind == "continue_statement":
            return [Statement("leave")]
        if kind == "return_statement":
            return [Statement("return", self._read(node.named_children[0], depth) if node.named_children else None)]
        if kind in {"alias_declaration", "type_definition", "using_declaration"}:
            self._read_alias(node, self._file.aliases)
        return []

    def _read_effect(self, node: Node, depth: int) -> list[Statement]:
        if node.type == "assignment_expression":
            left, right = node.child_by_field_name("left"), node.child_by_field_name("right")
            if left is not None and right is not None:
                target, value = self._read(left, depth), self._read(right, depth)
                sign = _text(node.child_by_field_name("operator"))
                if sign == "+=":
                    value = self._make(node, "join", None, (target, value))
                elif sign != "=":
                    value = self._make(node, "unknown")
                return [Statement("set", value, (target,))]
        return [Statement("do", self._read(node, depth))]

    def _read_declaration(self, node: Node, depth: int) -> list[Statement]:
        found: list[Statement] = []
        type_name = clean_type(_text(node.child_by_field_name("type")))
        for declarator in node.children_by_field_name("declarator"):
            name = _find_name(declarator)
            if not name:
                continue
            target = self._make(node, "name", name)
            value = declarator.child_by_field_name("value") if declarator.type == "init_declarator" else None
            is_held = any(
                child.type in {"pointer_declarator", "reference_declarator"}
                for child in (declarator, *declarator.named_children)
            )
            if declarator.type == "function_declarator":
                # `Type name(other);` in a function is no declaration of one, though it is spelled so.
                parameters = declarator.child_by_field_name("parameters")
                words = [
                    self._make(each, "name", clean_type(_text(each)))
                    for each in (parameters.named_children if parameters else ())
                ]
                value_expression: Expression | None = self._make(node, "call", None, (target, *words))
            elif value is None:
                value_expression = None if is_held else self._make(node, "call", None, (target,))
            elif value.type in {"argument_list", "initializer_list"}:
                arguments = [self._read(each, depth) for each in value.named_children]
                value_expression = self._make(value, "call", None, (target, *arguments))
            else:
                found.append(Statement("set", self._read(value, depth), (target,), type_name=type_name))
                continue
            found.append(Statement("local", value_expression, (target,), type_name=type_name))
        return found

    def _read(self, node: Node, depth: int) -> Expression:  # noqa: PLR0911, PLR0912, C901 - one for each form
        depth += 1
        kind = node.type
        if depth > MAX_DEPTH:
            return self._make(node, "unknown")
        if kind in {"identifier", "field_identifier", "namespace_identifier", "type_identifier", "primitive_type"}:
            return self._make(node, "name", _text(node))
        if kind == "this":
            return self._make(node, "name", "self")
        if kind in {"qualified_identifier", "template_function", "template_method", "template_type"}:
            made = self._make(node, "name")
            made.value, made.type_arguments = _split_templates(_text(node))
            return made
        if kind in {"string_literal", "raw_string_literal", "concatenated_string"}:
            return self._make(node, "value", _read_string(node))
        if kind == "char_literal":
            return self._make(node, "value", _text(node).strip("'"))
        if kind in {"number_literal", "true", "false", "nullptr"}:
            return self._make(node, "value", _read_number(_text(node)))
        if kind == "user_defined_literal":
            return self._make(node, "value", _text(node))
        if kind == "call_expression":
            function, arguments = node.child_by_field_name("function"), node.child_by_field_name("arguments")
            if function is not None and arguments is not None:
                parts = [self._read(each, depth) for each in (function, *_list_arguments(arguments))]
                made = self._make(node, "call", None, parts)
                made.type_arguments = parts[0].type_arguments
                return made
        if kind == "field_expression":
            inner, name = node.child_by_field_name("argument"), node.child_by_field_name("field")
            if inner is not None and name is not None:
                made = self._make(node, "member", None, (self._read(inner, depth),))
                made.value, made.type_arguments = _split_templates(_text(name))
                return made
        if kind in _IDENTITIES and node.named_children:
            return self._read(node.child_by_field_name("value") or node.named_children[-1], depth)
        if kind == "cast_expression":
            value = node.child_by_field_name("value")
            return self._make(node, "unknown") if value is None else self._read(value, depth)
        if kind in {"new_expression", "compound_literal_expression"}:
            type_node = node.child_by_field_name("type")
            arguments = node.child_by_field_name("arguments") or node.child_by_field_name("value")
            values = [self._read(each, depth) for each in (_list_arguments(arguments) if arguments is not None else ())]
            made = self._make(node, "call", None, (self._make(node, "name", "new"), *values))
            made.type_arguments = (clean_type(_text(type_node)),)
            return made
        if kind == "initializer_pair" and (value := node.child_by_field_name("value")) is not None:
            return self._read(value, depth)
        if kind == "initializer_list":
            return self._make(node, "list", None, [self._read(each, depth) for each in node.named_children])
        if kind == "lambda_expression":
            made = self._make(node, "lambda")
            declarator = node.child_by_field_name("declarator")
            parameters = (
                self._read_parameters(declarator.child_by_field_name("parameters"), depth) if declarator else ()
            )
            statements = self._read_block(node.child_by_field_name("body"), depth)
            made.body = Function("lambda", parameters, statements, self._file)
            return made
        if kind == "conditional_expression":
            names = ("condition", "consequence", "alternative")
            inner_nodes = [each for name in names if (each := node.child_by_field_name(name)) is not None]
            if len(inner_nodes) == len(names):
                return self._make(node, "choice", None, [self._read(each, depth) for each in inner_nodes])
        if kind == "subscript_expression":
            inner, keys = node.child_by_field_name("argument"), node.child_by_field_name("indices")
            if inner is not None and keys is not None and keys.named_children:
                parts = [self._read(inner, depth), self._read(keys.named_children[0], depth)]
                return self._make(node, "index", None, parts)
        if kind in {"binary_expression", "assignment_expression", "unary_expression"}:
            return self._read_operation(node, depth)
        return self._make(node, "unknown")

    def _read_operation(self, node: Node, depth: int) -> Expression:
        sign = _text(node.child_by_field_name("operator"))
        names = ("left", "right") if node.type != "unary_expression" else ("argument",)
        operands = [self._read(each, depth) for name in names if (each := node.child_by_field_name(name)) is not None]
        if sign == "+":
            return self._make(node, "join", None, operands)
        if sign == "-" and len(operands) == 1 and isinstance(operands[0].value, int | float):
            return self._make(node, "value", -operands[0].value)
        sign = {"&&": "and", "||": "or", "!": "not"}.get(sign, sign)
        return self._make(node, "call", None, (self._make(node, "name", sign), *operands))

    def _make(self, node: Node, kind: ExpressionKind, value: Any = None, parts: Any = ()) -> Expression:  # noqa: ANN401
        line, column = node.start_point
        text = " ".join(_text(node)[: _MAX_TEXT * 2].split())[:_MAX_TEXT] if kind != "value" else ""
        return Expression(kind, text, line + 1, column + 1, value, tuple(parts))


def _list_type_parameters(node: Node) -> tuple[str, ...]:
    """Return the parameters of a template that are types."""
    parameters = node.child_by_field_name("parameters")
    return tuple(
        _text(each.named_children[-1])
        for each in (parameters.named_children if parameters is not None else ())
        if each.type == "type_parameter_declaration" and each.named_children
    )


def _list_arguments(node: Node) -> list[Node]:
    return [each for each in node.named_children if each.type != "comment"]


def _find_body(node: Node) -> Node:
    return node.child_by_field_name("body") or node


def _find_name(node: Node | None) -> str:
    """Return the name that a declarator declares."""
    for _ in range(MAX_DEPTH):
        if node is None:
            return ""
        if node.type in {"identifier", "field_identifier", "type_identifier"}:
            return _text(node)
        inner = node.child_by_field_name("declarator")
        node = inner if inner is not None else node.named_children[-1] if node.named_children else None
    return ""


def _find_function(node: Node | None) -> Node | None:
    for _ in range(MAX_DEPTH):
        if node is None or node.type == "function_declarator":
            return node
        others = (each for each in node.named_children if each.type.endswith("_declarator"))
        node = node.child_by_field_name("declarator") or next(others, None)
    return None


def _split_templates(text: str) -> tuple[str, tuple[str, ...]]:
    """Return a name without what stands in `<...>`, and the types that stand in the last one."""
    words = "".join(text.split()).removeprefix("template")
    name, arguments, depth, start = "", "", 0, 0
    for place, sign in enumerate(words):
        if sign == "<":
            start = place + 1 if depth == 0 else start
            depth += 1
        elif sign == ">" and depth:
            depth -= 1
            arguments = words[start:place] if depth == 0 else arguments
        elif depth == 0:
            name += sign
    return name, split_type_arguments(arguments)


def split_type_arguments(text: str) -> tuple[str, ...]:
    """Return the types of a list with commas between them."""
    found, depth, start = [], 0, 0
    for place, sign in enumerate(text):
        depth += {"<": 1, ">": -1, "(": 1, ")": -1}.get(sign, 0)
        if sign == "," and depth == 0:
            found.append(clean_type(text[start:place]))
            start = place + 1
    return (*found, clean_type(text[start:])) if text else ()


def _read_string(node: Node) -> str:
    if node.type == "concatenated_string":
        return "".join(_read_string(each) for each in node.named_children if each.type.endswith("string_literal"))
    found = ""
    for child in node.named_children:
        text = _text(child)
        found += _ESCAPES.get(text[1:], text[1:]) if child.type == "escape_sequence" else text
    return found


def _read_number(text: str) -> Any:  # noqa: ANN401 - a number, a truth or nothing
    if text in {"true", "false", "nullptr"}:
        return {"true": True, "false": False}.get(text)
    plain = text.replace("'", "").rstrip("uUlLfF") if not text.startswith("0x") else text
    for read in (lambda: int(plain, 0), lambda: float(plain)):
        try:
            return read()
        except ValueError:
            continue
    return text
