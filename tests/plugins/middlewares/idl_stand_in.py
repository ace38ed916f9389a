"""A stand-in for omniidl, which no CI has: IDL as archgen writes it is read by a grammar of its own, and mapped to C++.

The mapping is that of "C++ Language Mapping" of the OMG, as far as generated components use it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from archgen.plugins.middlewares.middleware_names import IDL_KEYWORDS

_TOKEN = re.compile(r"\s+|//[^\n]*|#[^\n]*|(::|[A-Za-z_]\w*|[{}<>();,])")
_PRIMITIVES = {
    "boolean": "Boolean",
    "octet": "Octet",
    "short": "Short",
    "unsigned short": "UShort",
    "long": "Long",
    "unsigned long": "ULong",
    "long long": "LongLong",
    "unsigned long long": "ULongLong",
    "float": "Float",
    "double": "Double",
}


@dataclass
class IdlReader:
    """Reads IDL and writes C++; what IDL forbids is an AssertionError."""

    tokens: list[str]
    types: dict[str, str] = field(default_factory=dict)
    """What is known so far by its full name: `fixed`, `variable` or `list`."""

    def take(self, expected: str | None = None) -> str:
        """Return the next word."""
        token = self.tokens.pop(0)
        assert expected is None or token == expected, (token, expected, self.tokens[:8])
        return token

    def take_name(self, taken: set[str]) -> str:
        """Return a new name, which is no keyword and no other one in its scope, letters of either case."""
        name = self.take()
        assert re.fullmatch(r"[A-Za-z]\w*", name), name
        assert name.casefold() not in IDL_KEYWORDS, name
        assert name.casefold() not in taken, name
        taken.add(name.casefold())
        return name

    def take_type(self, space: str) -> tuple[str, str]:
        """Return a type in C++, and whether it is `fixed`, `variable`, `list` or `text`."""
        if self.tokens[0] == "string":
            self.take()
            return "CORBA::String_member", "text"
        words: list[str] = []
        while self.tokens[0] in {"unsigned", "long", "short", "boolean", "octet", "float", "double"}:
            words.append(self.take())
        if words:
            return f"CORBA::{_PRIMITIVES[' '.join(words)]}", "fixed"
        name = ""
        while self.tokens[0] == "::":
            self.take()
            name += f"::{self.take()}"
        if name == "::RTC::Time":
            return name, "fixed"
        assert name in self.types, (name, space)
        return name, self.types[name]

    def read_definitions(self, space: str, taken: set[str]) -> Iterator[str]:
        """Yield what a scope defines, in C++."""
        while self.tokens and self.tokens[0] != "}":
            kind = self.take()
            if kind == "module":
                # A module may be opened again.
                name = self.take()
                assert name.casefold() not in IDL_KEYWORDS, name
                self.take("{")
                yield f"namespace {name} {{"
                yield from self.read_definitions(f"{space}::{name}", set())
                yield "}"
                self.take("}")
            elif kind == "struct":
                yield from self._read_struct(space, taken)
            elif kind == "typedef":
                yield from self._read_typedef(space, taken)
            else:
                assert kind == "interface", kind
                yield from self._read_interface(space, taken)
            self.take(";")

    def _read_struct(self, space: str, taken: set[str]) -> Iterator[str]:
        name = self.take_name(taken)
        self.take("{")
        members = {name.casefold()}
        lines, kinds = [], set[str]()
        while self.tokens[0] != "}":
            cpp, kind = self.take_type(space)
            kinds.add(kind)
            lines.append(f"{cpp} {self.take_name(members)};")
            self.take(";")
        assert lines, f"{name} is empty"
        self.take("}")
        self.types[f"{space}::{name}"] = "fixed" if kinds == {"fixed"} else "variable"
        yield f"struct {name} {{ {' '.join(lines)} }};"
        yield f"using {name}_var = CORBA::Var<{name}>;"

    def _read_typedef(self, space: str, taken: set[str]) -> Iterator[str]:
        if self.tokens[0] != "sequence":
            cpp, _ = self.take_type(space)
            yield f"typedef {cpp} {self.take_name(taken)};"
            return
        self.take("sequence")
        self.take("<")
        cpp, _ = self.take_type(space)
        self.take(">")
        name = self.take_name(taken)
        self.types[f"{space}::{name}"] = "list"
        yield f"class {name} : public CORBA::Sequence<{cpp}> {{}};"
        yield f"using {name}_var = CORBA::Var<{name}>;"

    def _read_interface(self, space: str, taken: set[str]) -> Iterator[str]:
        name = self.take_name(taken)
        self.take("{")
        operations = {name.casefold()}
        methods: list[str] = []
        while self.tokens[0] != "}":
            is_oneway = self.tokens[0] == "oneway"
            if is_oneway:
                self.take()
            if self.tokens[0] == "void":
                result = self.take()
            else:
                assert not is_oneway
                cpp, kind = self.take_type(space)
                result = {"text": "char *", "fixed": cpp}.get(kind, f"{cpp} *")
            operation = self.take_name(operations)
            self.take("(")
            arguments: list[str] = []
            names = {operation.casefold()}
            while self.tokens[0] != ")":
                self.take("in")
                cpp, kind = self.take_type(space)
                is_small = kind == "fixed" and cpp.startswith("CORBA::")
                written = "const char *" if kind == "text" else cpp if is_small else f"const {cpp} &"
                arguments.append(f"{written} {self.take_name(names)}")
                if self.tokens[0] == ",":
                    self.take()
            self.take(")")
            self.take(";")
            methods.append(f"virtual {result} {operation}({', '.join(arguments)}) = 0;")
        self.take("}")
        yield f"class {name} {{ public: virtual ~{name}(); {' '.join(methods)} }};"


def write_skeleton(idl: str) -> str:
    """Return the header that stands for the one that omniidl makes of an IDL file."""
    tokens: list[str] = []
    position = 0
    while position < len(idl):
        match = _TOKEN.match(idl, position)
        assert match, idl[position : position + 80]
        if match[1]:
            tokens.append(match[1])
        position = match.end()
    space = tokens[1]
    lines = list(IdlReader(tokens).read_definitions("", set()))
    head = "#pragma once\n#include <rtm/idl/BasicDataTypeSkel.h>\n"
    # A servant is derived from a class of its own namespace.
    return (
        head
        + "\n".join(lines)
        + f"\nnamespace POA_{space} {{ namespace services {{ using namespace {space}::services; }} }}\n"
    )
