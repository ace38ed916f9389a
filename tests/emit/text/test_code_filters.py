"""Text of the model in generated code: the parsers of the languages read it back, and it never gets out."""

from __future__ import annotations

import ast
import io
import math
import re
import shlex
import subprocess
import tokenize
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
import yaml
from hypothesis import example, given
from hypothesis import strategies as st

from archgen.emit.text import template_filters
from tests.outside_tools import find_tool, run_judge

HOSTILE = (
    '"; os.system("x") #',
    "'; rm -rf / #",
    "$(touch x) `touch x` ${HOME} !x",
    "*/ int evil; /*",
    "?> <x/> --> ]]> <!--",
    "a\\",
    "??/",
    "??'??)??(",
    "\\u0022; evil(); //",
    "\\u000a evil();",
    "line one\nline two\r\nthree\u2028four\u2029five\x85six\x0bseven\x0ceight",
    "\ufeff\u202e\u0000\x1b[31m\x7f",
    "%s %d {} {{ }} {% %}",
    "yes",
    "1e3",
    "---",
    "- a: b",
    "#",
    "~",
    "''' \"\"\"",
    'R"(x)"',
    "ä€𝄞",
    "",
    " ",
    "\ud800",
)
TEXTS = st.text() | st.sampled_from(HOSTILE) | st.text(st.sampled_from("'\"\\*/?$`#%<>&!-\n\r\t\0u0"))


def _plain(text: str) -> str:
    """Return text without halves of characters, which no file can hold."""
    return text.encode("utf-16", "replace").decode("utf-16", "replace")


@given(TEXTS)
@example("\ud800")
def test_a_string_of_python(text: str) -> None:
    written = template_filters.write_python_string(text)
    assert written.isascii()
    assert written.isprintable()
    assert ast.literal_eval(written) == text


@given(TEXTS)
def test_a_word_of_the_shell(text: str) -> None:
    wanted = text.replace("\0", "")
    assert shlex.split(template_filters.write_shell_word(text)) == [wanted]


@pytest.mark.parametrize("shell", ["sh", "bash"])
def test_shells_read_words_back(shell: str) -> None:
    texts = [_plain(text).replace("\0", "") for text in HOSTILE]
    script = "printf '%s\\0' " + " ".join(template_filters.write_shell_word(text) for text in texts)
    done = subprocess.run([shell, "-c", script], capture_output=True, check=True)  # noqa: S603 - printf
    assert done.stdout.decode().split("\0")[:-1] == texts
    assert done.stderr == b""


@given(TEXTS | st.integers() | st.booleans() | st.none() | st.floats(allow_nan=False))
def test_a_scalar_of_yaml(value: object) -> None:
    written = template_filters.write_yaml_scalar(value)
    assert len(written.splitlines()) == 1
    expected = _plain(value) if isinstance(value, str) else value
    assert yaml.safe_load(f"a: [{written}, x]\nb: {written}\n") == {"a": [expected, "x"], "b": expected}
    assert type(yaml.safe_load(f"a: {written}")["a"]) is type(expected)


@given(TEXTS)
def test_text_of_xml(text: str) -> None:
    written = template_filters.write_xml(text)
    document = ET.fromstring(f"<a b=\"{written}\" c='{written}'>{written}</a>")  # noqa: S314 - just made
    wanted = "".join(
        each
        if each in "\t\n\r" or (each >= " " and each not in "\ufffe\uffff" and not "\ud800" <= each <= "\udfff")
        else "\ufffd"
        for each in text
    )
    assert (document.get("b"), document.get("c"), document.text or "") == (wanted, wanted, wanted)
    assert list(document) == []


@given(TEXTS)
def test_a_comment_on_one_line(text: str) -> None:
    written = template_filters.write_line_comment(text)
    assert len(f"x{written}".splitlines()) == 1
    assert not any(mark in f"{written} " for mark in ("*/", "/*", "?>", "-->", "--", "??", "\\", "\n", "\r", "\0"))
    tokens = list(tokenize.generate_tokens(io.StringIO(f"# {written}\nx = 1\n").readline))
    assert [each.type for each in tokens][:2] == [tokenize.COMMENT, tokenize.NL]
    document = ET.fromstring(f"<a><!-- {template_filters.write_xml(written)} --><b/></a>")  # noqa: S314 - just made
    assert [each.tag for each in document] == ["b"]


CPP = """\
#include <cstdio>
{comments}
const char *const TEXTS[] = {{ {texts} }};
const unsigned SIZES[] = {{ {sizes} }};
int main() {{
  for (unsigned i = 0; i < {count}; ++i) std::fwrite(TEXTS[i], 1, SIZES[i], stdout);
}}
"""


@pytest.mark.slow
def test_strings_and_comments_of_cpp(tmp_path: Path) -> None:
    texts = [_plain(text) for text in HOSTILE]
    data = [text.encode() for text in texts]
    code = CPP.format(
        comments="\n".join(
            f"// {template_filters.write_line_comment(text)}\n/* {template_filters.write_line_comment(text)} */"
            for text in HOSTILE
        ),
        texts=", ".join(template_filters.write_cpp_string(text) for text in texts),
        sizes=", ".join(str(len(each)) for each in data),
        count=len(data),
    )
    (tmp_path / "a.cpp").write_text(code)
    for standard in ("c++11", "c++17"):
        words = (f"-std={standard}", "-trigraphs", "-Wall", "-Wextra", "-Werror", "a.cpp", "-o", "a")
        run_judge(find_tool("g++"), *words, cwd=tmp_path)
        done = subprocess.run(["./a"], cwd=tmp_path, check=True, capture_output=True)
        assert done.stdout == b"".join(data)


def _read_java(written: str) -> str:
    """Read a string as a compiler of Java does: first its unicode escapes, everywhere; then the escapes of strings."""
    assert written.isascii()
    # A backslash behind an odd number of them starts none.
    units = re.sub(r"\\\\|\\u+([0-9a-f]{4})", lambda found: chr(int(found[1], 16)) if found[1] else found[0], written)
    inner = units[1:-1]
    assert re.fullmatch(r'(?:[^"\\\n\r]|\\[btnfr"\\]|\\[0-3][0-7]{2})*', inner, re.DOTALL), inner
    named = {"b": "\b", "t": "\t", "n": "\n", "f": "\f", "r": "\r", '"': '"', "\\": "\\"}
    text = re.sub(
        r'\\(?:([btnfr"\\])|([0-7]{3}))',
        lambda found: named[found[1]] if found[1] else chr(int(found[2], 8)),
        inner,
    )
    return text.encode("utf-16-be", "surrogatepass").decode("utf-16-be", "surrogatepass")


@given(TEXTS)
def test_a_string_of_java(text: str) -> None:
    # Joined halves are one character: pairs are compared.
    assert _read_java(template_filters.write_java_string(text)) == text.encode("utf-16-be", "surrogatepass").decode(
        "utf-16-be", "surrogatepass"
    )


@given(TEXTS)
def test_a_string_of_cpp_has_plain_characters_only(text: str) -> None:
    written = template_filters.write_cpp_string(text)
    assert re.fullmatch(r'"(?:[ !#-\>@-\[\]-~]|\\["\\?nt]|\\[0-3][0-7]{2})*"', written)


@pytest.mark.parametrize(
    ("name", "value", "written"),
    [
        ("camel", "left_arm_1", "LeftArm1"),
        ("camel", "RGBDImage", "RgbdImage"),
        ("snake", "LeftArm", "left_arm"),
        ("python_name", "class", "class_"),
        ("cpp_name", "class", "class_"),
        ("java_name", "goto", "goto_"),
        ("java_value", True, "true"),
        ("java_value", -(2**63), "-9223372036854775808L"),
        ("java_value", 1.5, "1.5"),
        ("java_value", 1e16, "1e+16"),
        ("java_value", -math.inf, "Double.NEGATIVE_INFINITY"),
        ("java_value", math.nan, "Double.NaN"),
        ("java_value", 'a"\n', '"a\\"\\n"'),
        ("java_value", [1, "x", [False]], 'List.of(1L, "x", List.of(false))'),
        ("ros_name", "import", "import_x"),
        ("shell_word", 3, "3"),
        ("yaml_scalar", 1e16, "1.0e+16"),
    ],
)
def test_filters_by_name(name: str, value: object, written: str) -> None:
    assert template_filters.CODE_FILTERS[name](value) == written
