"""The frame of a page: what stands there only where there is something to show, and nothing that is not escaped."""

from __future__ import annotations

import pytest

from archgen.emit.site.page_frame import FrameParts, write_frame
from archgen.frozen import replace

BARE = FrameParts(
    title="Rover",
    revision="",
    version="",
    policy="default-src 'none'",
    root="../",
    start="../index.html",
    heading="Eye",
    lead="",
    crumbs=(),
    contents=(("Inputs", "inputs"),),
    explorer_style="",
    explorer_begin="",
    explorer_scripts=(),
    explorer_link="",
    navigation_html="<ul></ul>",
    place_html="",
    verdict_html="",
    notices_html=(),
    dashboard_html="",
    matrix_html="",
    waterfall_html="",
    content_html="<p>Sees.</p>",
)


@pytest.mark.parametrize(
    ("part", "value", "html"),
    [
        ("heading", "Rover", "<title>Rover</title>"),
        ("revision", "1a2b", '<span class="revision">1a2b</span>'),
        ("version", "7", '<html lang="en" data-version="7">'),
        ("version", "7", '<script src="../live/live.js" defer></script>'),
        ("lead", "A camera", '<p class="lead">A camera</p>'),
        (
            "crumbs",
            (("Rover", "../index.html"), ("Gone", None)),
            '<li><a href="../index.html">Rover</a></li>\n<li>Gone</li>',
        ),
        ("contents", (("In", "in"), ("Out", "out")), '<li><a href="#in">In</a></li>\n<li><a href="#out">Out</a></li>'),
        ("explorer_link", "../e.html#a&b", '<a href="../e.html#a&amp;b">Show in explorer</a>'),
        ("explorer_scripts", ("../a.js",), '<script src="../a.js" defer></script>'),
        ("verdict_html", "<b>late</b>", '<div class="title"><h1>Eye</h1> <b>late</b></div>'),
        ("place_html", "<code>a.yaml:3</code>", '<p class="written">Written in <code>a.yaml:3</code></p>'),
        ("notices_html", ("<p>Mind.</p>",), "</h1>\n<p>Mind.</p>\n"),
        ("matrix_html", "<table></table>", '<link rel="stylesheet" href="../assets/matrix.css">'),
        ("waterfall_html", "<div></div>", "<div></div>\n<p>Sees.</p>"),
    ],
)
def test_a_part_stands_there_where_there_is_one(part: str, value: object, html: str) -> None:
    assert html not in write_frame(BARE)
    assert html in write_frame(replace(BARE, **{part: value}))  # type: ignore[arg-type]


@pytest.mark.parametrize("part", ["title", "revision", "version", "heading", "lead", "start", "root", "explorer_link"])
def test_what_is_no_html_is_escaped(part: str) -> None:
    html = write_frame(replace(BARE, **{part: '"><script>x</script>'}))  # type: ignore[arg-type]
    assert "<script>x" not in html
    assert "&quot;&gt;&lt;script&gt;x" in html


def test_the_policy_is_whole() -> None:
    assert 'content="default-src &#39;none&#39;"' in write_frame(BARE)
