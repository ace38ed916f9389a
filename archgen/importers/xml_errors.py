"""Say in plain words why an XML parser refuses a file."""

from __future__ import annotations

from xml.parsers import expat

from archgen.frozen import dataclass

_ENCODING_HELP = "save it as UTF-8, and let its first line say so"
_WRONG_ENCODINGS = frozenset({expat.errors.XML_ERROR_UNKNOWN_ENCODING, expat.errors.XML_ERROR_INCORRECT_ENCODING})
_UNENDED = frozenset(
    {
        expat.errors.XML_ERROR_NO_ELEMENTS,
        expat.errors.XML_ERROR_UNCLOSED_TOKEN,
        expat.errors.XML_ERROR_PARTIAL_CHAR,
        expat.errors.XML_ERROR_UNCLOSED_CDATA_SECTION,
    }
)


@dataclass(frozen=True, slots=True)
class XmlProblem:
    """Why a file is not read, and what to do."""

    message: str
    help_line: str
    is_at_end: bool = False
    """Whether it shows at the place that the parser has come to, rather than at the error's own."""


def explain_syntax(error: expat.ExpatError, *, is_root_seen: bool, malformed_help: str) -> XmlProblem:
    """Explain what is wrong with the text of a file; `malformed_help` says what to do where it is no XML."""
    message = expat.ErrorString(error.code)
    if message in _UNENDED:
        words = "only the first part of a file is there: it ends before its elements do"
        words = words if is_root_seen else "it is empty, or no XML: there is no element in it"
        return XmlProblem(words, "export it again, or copy it again as a whole", is_at_end=True)
    if message in _WRONG_ENCODINGS:
        return XmlProblem(f"its encoding cannot be read ({message})", _ENCODING_HELP, is_at_end=True)
    return XmlProblem(f"this is not XML as it should be ({message})", malformed_help)


def explain_encoding(error: LookupError | ValueError) -> XmlProblem:
    """Explain that Python, which expat asks, does not know the encoding of the file's first line."""
    return XmlProblem(f"its encoding cannot be read ({error})", _ENCODING_HELP, is_at_end=True)
