"""SVG pictures of a project: what is taken out of them, and what stays."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.link.report_chapters import clean_project_svg, is_svg
from archgen.pipeline import check_project

SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 9 9"{0}>{1}</svg>'
)


@pytest.mark.parametrize(
    ("attributes", "content"),
    [
        ("", "<script>document.title='PWNED'</script>"),
        (' onload="alert(1)"', ""),
        ("", '<rect onclick="alert(1)"/>'),
        ("", '<image href="http://127.0.0.1:9/x.png"/>'),
        ("", '<image xlink:href="http://127.0.0.1:9/x.png"/>'),
        ("", '<image href="//127.0.0.1:9/x.png"/>'),
        ("", '<image href="/etc/passwd"/>'),
        ("", '<use href="other.svg#part"/>'),
        ("", '<use href="data:image/svg+xml;base64,AAAA"/>'),
        ("", "<style>@import url(http://127.0.0.1:9/a.css);</style>"),
        ("", "<style>@import 'http://127.0.0.1:9/a.css';</style>"),
        ("", "<style>@font-face{src:url(http://127.0.0.1:9/f)}</style>"),
        ("", '<rect style="fill:url(http://127.0.0.1:9/x)"/>'),
        ("", '<a href="javascript:alert(1)"><rect/></a>'),
        ("", '<animate attributeName="href" to="javascript:alert(1)"/>'),
        ("", '<foreignObject><iframe xmlns="http://www.w3.org/1999/xhtml" src="http://127.0.0.1:9"/></foreignObject>'),
        ("", '<feImage href="http://127.0.0.1:9/x.png"/>'),
    ],
)
def test_nothing_runs_and_nothing_is_loaded(attributes: str, content: str) -> None:
    cleaned = clean_project_svg(SVG.format(attributes, content).encode())
    assert cleaned is not None
    text = cleaned.decode()
    for word in (
        "<script",
        "onload",
        "onclick",
        "alert",
        "@import url",
        "127.0.0.1:9/x",
        "/etc",
        "other.svg",
        "iframe",
    ):
        assert word not in text.replace('to="javascript:alert(1)"', "")
    assert 'attributeName="href"' not in text
    assert "svg+xml" not in text


def test_a_drawing_stays_what_it_is() -> None:
    content = (
        '<defs><linearGradient id="g"><stop offset="0" style="stop-color:#fff"/></linearGradient></defs>'
        "<style>.a{fill:url(#g)}</style>"
        '<rect class="a" width="3" filter="url(#f)"/><use href="#g"/><image href="data:image/png;base64,AAAA"/>'
    )
    cleaned = clean_project_svg(SVG.format("", content).encode())
    assert cleaned is not None
    for kept in (
        'viewBox="0 0 9 9"',
        ".a{fill:url(#g)}",
        'href="#g"',
        "base64,AAAA",
        'filter="url(#f)"',
        "stop-color:#fff",
    ):
        assert kept in cleaned.decode()
    assert clean_project_svg(cleaned) == cleaned


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"<svg",
        b"<html><body/></html>",
        b'<!DOCTYPE svg [<!ENTITY a "b">]><svg xmlns="http://www.w3.org/2000/svg"><text>&a;</text></svg>',
    ],
)
def test_what_is_no_sound_svg_is_refused(data: bytes) -> None:
    assert clean_project_svg(data) is None


def test_pixels_are_not_touched(tmp_path: Path) -> None:
    png = b"\x89PNG\r\n\x1a\n<script>"
    assert not is_svg(png)
    (tmp_path / "archgen.yaml").write_text("archgen: 1\nproject: {id: x}\n", encoding="utf-8")
    (tmp_path / "a.png").write_bytes(png)
    (tmp_path / "b.svg").write_text("\ufeff \n" + SVG.format("", "<script>x</script>"), encoding="utf-8")
    chapters = check_project(tmp_path).chapters
    assert chapters.read_picture("a.png") == png
    assert b"script" not in (chapters.read_picture("b.svg") or b"script")
