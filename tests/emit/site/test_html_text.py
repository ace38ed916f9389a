"""Text and addresses in a page."""

from __future__ import annotations

import pytest

from archgen.emit.site import html_text


@pytest.mark.parametrize(
    ("text", "html"),
    [
        ("a < b & 'c'", "a &lt; b &amp; &#x27;c&#x27;"),
        ('"', "&quot;"),
        ("\x00\x1b\x9f", "\ufffd\ufffd\ufffd"),
        ("a\tb\nc", "a\tb\nc"),
        ("\ud800", "\ufffd"),
    ],
)
def test_text_is_escaped_and_holds_nothing_that_html_forbids(text: str, html: str) -> None:
    assert html_text.escape_html(text) == html


@pytest.mark.parametrize(
    ("text", "html"),
    [
        ("environment_state.object_recognition", "environment_<wbr>state.<wbr>object_<wbr>recognition"),
        ("short_name", "short_name"),
        ("several plain_words in_a row_of them", "several plain_words in_a row_of them"),
        ("<aaaaaaaaaa.bbbbbbbbbbb>", "&lt;aaaaaaaaaa.<wbr>bbbbbbbbbbb&gt;"),
    ],
)
def test_long_names_may_break_and_entities_never(text: str, html: str) -> None:
    assert html_text.escape_breakable(text) == html


@pytest.mark.parametrize(
    ("url", "address"),
    [
        ("https://a.org/?b&c", "https://a.org/?b&amp;c"),
        ("HTTP://a.org", "HTTP://a.org"),
        ("mailto:a@b.org", "mailto:a@b.org"),
        ("javascript:alert(1)", None),
        ("data:text/html,x", None),
        ("https:///x", None),
        ("//a.org", None),
        (" https://a.org", None),
        ("", None),
        (None, None),
    ],
)
def test_only_web_and_mail_become_links(url: str | None, address: str | None) -> None:
    assert html_text.web_address(url) == address


def test_ids_hold_no_blank_and_no_quote() -> None:
    assert html_text.make_element_id('type:Colour image "x"') == "type:Colour-image-x-"


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("<= 15 Hz · >= 66.667 ms", "≤ 15 Hz · ≥ 66.667 ms"),
        ("60 us to 20 ms", "60 µs to 20 ms"),
        ("a <= b", "a <= b"),
        ("between us", "between us"),
        ("x==1", "x==1"),
    ],
)
def test_signs_and_units_of_figures_are_written_as_people_do(text: str, written: str) -> None:
    assert html_text.write_signs(text) == written


def test_a_short_figure_shows_all_of_it_when_pointed_at() -> None:
    html = html_text.write_figures("a<b >= 7223.333 ms")
    assert html == 'a&lt;b <span class="short" title="≥ 7223.333 ms">≥ 7.22 s</span>'


def test_where_no_element_can_be_figures_are_short_all_the_same() -> None:
    assert html_text.shorten_figures("waits <= 4166.667 ms, 60 us") == "waits ≤ 4.17 s, 60 µs"
