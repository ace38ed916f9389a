"""Words that no name may be in the languages of generated code."""

from __future__ import annotations

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
