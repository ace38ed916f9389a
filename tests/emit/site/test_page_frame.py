"""The frame of every page: what is not HTML is escaped, and what a page has not leaves no empty shell."""

from __future__ import annotations

from dataclasses import replace

from archgen.emit.site.page_frame import PageFrame, write_frame

HOSTILE = "<script>alert('1')</script> & \"more\"\x07"
ESCAPED = "&lt;script&gt;alert(&#x27;1&#x27;)&lt;/script&gt; &amp; &quot;more&quot;\ufffd"
PLAIN = PageFrame(
    site_title="Rover",
    revision="",
    version="",
    policy="default-src 'none'",
    root="../",
    start="../index.html",
    heading="Eye",
    lead="",
    crumbs=(),
    contents=(("Ports", "ports"),),
    navigation="<ul></ul>",
    verdict="",
    place="",
    notices=(),
    dashboard="",
    matrix="",
    waterfall="",
    content="<p>Sees.</p>",
)


def test_a_plain_page_has_its_title_its_content_and_nothing_empty() -> None:
    html = write_frame(PLAIN)
    assert html.startswith('<!DOCTYPE html>\n<html lang="en">\n<head>\n')
    assert html.endswith("<p>Sees.</p>\n</main>\n</div>\n</body>\n</html>")
    assert "<title>Eye · Rover</title>" in html
    assert '<meta http-equiv="Content-Security-Policy" content="default-src &#x27;none&#x27;">' in html
    assert '<link rel="stylesheet" href="../assets/site.css">' in html
    # One section needs no list of sections; nothing is asked of a server.
    for absent in ("crumbs", "contents", "revision", "lead", "explore", "written", "matrix", "live/", "data-version"):
        assert absent not in html, absent


def test_all_text_of_a_frame_is_escaped() -> None:
    page = replace(
        PLAIN,
        site_title=HOSTILE,
        revision=HOSTILE,
        version=HOSTILE,
        heading=HOSTILE,
        lead=HOSTILE,
        crumbs=((HOSTILE, None), (HOSTILE, f"../{HOSTILE}")),
        contents=((HOSTILE, HOSTILE), ("Second", "second")),
        explorer_link=HOSTILE,
    )
    html = write_frame(page)
    assert "<script>alert" not in html
    assert "\x07" not in html
    # Title and heading are the same words, so that the window's title has them once.
    assert html.count(ESCAPED) == 12
    assert f"<title>{ESCAPED}</title>" in html


def test_what_a_page_has_stands_in_its_place() -> None:
    page = replace(
        PLAIN,
        version="3",
        crumbs=(("Rover", "../index.html"), ("Senses", None)),
        contents=(("Ports", "ports"), ("Chains", "chains")),
        verdict="<b>met</b>",
        place="<code>a.yaml:3</code>",
        notices=("<p>Only a part.</p>",),
        dashboard="<div>figures</div>",
        matrix="<table></table>",
        waterfall="<div>bars</div>",
        explorer_style="../assets/explorer/explorer.css",
        explorer_begin="../assets/explorer/data.js",
        explorer_scripts=("../assets/explorer/main.js",),
    )
    html = write_frame(page)
    order = [
        'data-version="3"',
        "explorer.css",
        "data.js",
        "matrix.css",
        "theme.js",
        "live/live.js",
        "search.js",
        "explorer/main.js",
        '<li><a href="../index.html">Rover</a></li>\n<li>Senses</li>',
        '<div class="title"><h1>Eye</h1> <b>met</b></div>',
        "Written in <code>a.yaml:3</code>",
        "<p>Only a part.</p>",
        '<li><a href="#ports">Ports</a></li>\n<li><a href="#chains">Chains</a></li>',
        "<div>figures</div>\n<table></table>\n<div>bars</div>\n<p>Sees.</p>",
    ]
    positions = [html.index(part) for part in order]
    assert positions == sorted(positions)
