"""Names of elements as identifiers of programming languages. Two names may become one: see `architecture_needs`.

Words that no name may be in the languages of generated code.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from functools import lru_cache

from archgen.model.element_ids import spell_in_ascii

PYTHON_KEYWORDS = frozenset(
    [
        "False", "None", "True", "and", "as", "assert", "async", "await", "break", "class", "continue", "def",
        "del", "elif", "else", "except", "exec", "finally", "for", "from", "global", "if", "import", "in", "is",
        "lambda", "nonlocal", "not", "or", "pass", "print", "raise", "return", "try", "while", "with", "yield"
    ]
)  # fmt: skip
"""Those of Python 3, with the two more that Python 2 has."""

CPP_KEYWORDS = frozenset(
    [
        "alignas", "alignof", "and", "and_eq", "asm", "atomic_cancel", "atomic_commit", "atomic_noexcept", "auto",
        "bitand", "bitor", "bool", "break", "case", "catch", "char", "char16_t", "char32_t", "char8_t", "class",
        "co_await", "co_return", "co_yield", "compl", "concept", "const", "const_cast", "consteval", "constexpr",
        "constinit", "continue", "decltype", "default", "delete", "do", "double", "dynamic_cast", "else", "enum",
        "explicit", "export", "extern", "false", "final", "float", "for", "friend", "goto", "if", "import",
        "inline", "int", "linux", "long", "main", "module", "mutable", "namespace", "new", "noexcept", "not",
        "not_eq", "nullptr", "operator", "or", "or_eq", "override", "private", "protected", "public", "reflexpr",
        "register", "reinterpret_cast", "requires", "restrict", "return", "short", "signed", "sizeof", "static",
        "static_assert", "static_cast", "std", "struct", "switch", "synchronized", "template", "this",
        "thread_local", "throw", "true", "try", "typedef", "typeid", "typename", "typeof", "union", "unix",
        "unsigned", "using", "virtual", "void", "volatile", "wchar_t", "while", "xor", "xor_eq"
    ]
)  # fmt: skip
"""Those of C++ up to 23, words of C that compilers take for theirs, macros of GCC, and names that mean something else."""

JAVA_KEYWORDS = frozenset(
    [
        "_", "abstract", "assert", "boolean", "break", "byte", "case", "catch", "char", "class", "const",
        "continue", "default", "do", "double", "else", "enum", "extends", "false", "final", "finally", "float",
        "for", "goto", "if", "implements", "import", "instanceof", "int", "interface", "long", "native", "new",
        "null", "package", "permits", "private", "protected", "public", "record", "return", "sealed", "short",
        "static", "strictfp", "super", "switch", "synchronized", "this", "throw", "throws", "transient", "true",
        "try", "var", "void", "volatile", "when", "while", "yield"
    ]
)  # fmt: skip
"""Those of Java up to 21, with those that are so in some places only."""

AADL_KEYWORDS = frozenset(
    [
        "aadlboolean", "aadlinteger", "aadlreal", "aadlstring", "abstract", "access", "all", "and", "annex",
        "applies", "binding", "bus", "calls", "classifier", "client", "compute", "connections", "constant", "data",
        "delta", "device", "end", "enumeration", "event", "extends", "false", "feature", "features", "flow",
        "flows", "group", "implementation", "in", "inherit", "initial", "inverse", "is", "list", "memory", "mode",
        "modes", "none", "not", "of", "or", "out", "package", "parameter", "path", "port", "private", "process",
        "processor", "properties", "property", "prototypes", "provides", "public", "range", "record", "reference",
        "refined", "renames", "requires", "self", "server", "set", "sink", "source", "subcomponents", "subprogram",
        "system", "thread", "to", "true", "type", "units", "virtual", "with"
    ]
)  # fmt: skip
"""Those of AADL 2.2, and of AADL 1 as readers of both refuse them; letters count alike in either case."""

ROS_KEYWORDS = PYTHON_KEYWORDS | CPP_KEYWORDS
"""A name of ROS becomes one in the languages in which its messages, packages and parameters are used."""


MAX_NAME_LENGTH = 100
_WORD = re.compile(r"[A-Z]+(?![a-z])[0-9]*|[A-Z]?[a-z0-9]+|[A-Z]|[0-9]+")
_KEYWORDS: Mapping[str, frozenset[str]] = {
    "python": PYTHON_KEYWORDS,
    "cpp": CPP_KEYWORDS,
    "java": JAVA_KEYWORDS,
}


def list_name_words(name: str) -> list[str]:
    """Return the words of a name in ASCII: `left_arm`, `LeftArm` and `Left arm` have the same two."""
    return _WORD.findall(spell_in_ascii(name))


@lru_cache(16_384)
def make_snake_name(name: str) -> str:
    """Return a name in small words: `left_arm`. It is never empty, begins with a letter, and has at most 100 characters."""
    return _finish_name("_".join(word.lower() for word in list_name_words(name)), name, "x")


@lru_cache(16_384)
def make_camel_name(name: str) -> str:
    """Return a name in words that begin with a capital: `LeftArm`. It is never empty, and begins with a letter."""
    return _finish_name("".join(word[0].upper() + word[1:].lower() for word in list_name_words(name)), name, "X")


@lru_cache(16_384)
def make_lower_camel_name(name: str) -> str:
    """Return a name in words of which all but the first begin with a capital: `leftArm`. It is as `make_camel_name` says."""
    camel_name = make_camel_name(name)
    return camel_name[0].lower() + camel_name[1:]


@lru_cache(16_384)
def make_identifier_in(language: str, name: str) -> str:
    """Return a name as an identifier of `python`, `cpp` or `java`, letters of either case; a keyword gets `_` behind it."""
    # Two underscores in a row, or one in front, are the compiler's and the library's own.
    identifier = _finish_name("_".join(re.findall(r"[A-Za-z0-9]+", spell_in_ascii(name))), name, "x")
    return f"{identifier}_" if identifier in _KEYWORDS[language] else identifier


@lru_cache(16_384)
def make_ros_name(name: str) -> str:
    """Return a name as packages, nodes, parameters and fields of ROS have it; a keyword gets `_x` behind it.

    No name of ROS 2 ends in an underscore, or has two in a row.
    """
    ros_name = make_snake_name(name)
    return f"{ros_name}_x" if ros_name in ROS_KEYWORDS else ros_name


def _finish_name(made_name: str, name: str, prefix: str) -> str:
    """Return what was made of a name with a letter in front and not too long; a name without any letter gets a digest."""
    if not made_name:
        return f"{prefix}_{_digest(name)}" if prefix == "x" else f"{prefix}{_digest(name)}"
    if made_name[0].isdigit():
        made_name = prefix + made_name
    if len(made_name) > MAX_NAME_LENGTH:
        made_name = f"{made_name[: MAX_NAME_LENGTH - 7].rstrip('_')}_{_digest(name)}"
    return made_name


def _digest(name: str) -> str:
    return hashlib.sha256(name.encode("utf-8", "replace")).hexdigest()[:6]
