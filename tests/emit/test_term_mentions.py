"""Where texts mention the terms of the glossary."""

from __future__ import annotations

import pytest

from archgen.emit.site.chapter_html import ChapterWriter
from archgen.emit.site.page_links import collect_links, open_page
from archgen.emit.term_mentions import begin_text
from archgen.views.shapes import Column, Markdown, Page, Section, Table, Text

ANCHORS = (
    "page:glossary",
    "term:Arm",
    "term:robot arm",
    "term:IT",
    "term:it",
    "term:MCI",
    "term:C++",
    "term:étude",
    "term:.*",
)


@pytest.mark.parametrize(
    ("text", "mentions"),
    [
        ("The arm, the Arm.", "Arm=arm"),
        ("A robot\n arm and an arm", "robot arm=robot\n arm, Arm=arm"),
        ("IT is it, not It", "IT=IT, it=it"),
        ("mci Mci MCI", "MCI=MCI"),
        ("army charm arms arm_1", ""),
        ("C++, .* and Étude", "C++=C++, .*=.*, étude=Étude"),
        ("", ""),
    ],
)
def test_the_first_mention_of_each_term_counts(text: str, mentions: str) -> None:
    finder = begin_text(ANCHORS)
    assert finder is not None
    found = [(each.anchor.removeprefix("term:"), text[each.start : each.end]) for each in finder.find_mentions(text)]
    assert ", ".join(f"{term}={words}" for term, words in found) == mentions


def test_without_terms_nothing_is_looked_for() -> None:
    assert begin_text(("page:index", "component:a")) is None


def write(text: str) -> str:
    rows = (((Text("Arm"),), (Text("A limb"),)), ((Text("<b>"),), (Text("Bold"),)))
    table = Table("table:glossary", "Terms", (Column("Term"), Column("Meaning")), rows, ("term:Arm", "term:<b>"))
    glossary = Page(
        "glossary.html", "page:glossary", "Glossary", "spanning", Section("page:glossary", "Glossary", (table,))
    )
    page = Page("g/a.html", "group:a", "A", "groups", Section("group:a", "A"))
    links = collect_links((glossary, page))
    return ChapterWriter(lambda _path: None).write_html(Markdown(text), 1, open_page("g/a.html", links))


def test_a_page_leads_to_the_glossary_but_not_from_headings_links_and_code() -> None:
    arm = '<a href="../glossary.html#term:Arm">'
    assert write("The *arm*, the arm.").strip() == f"<p>The <em>{arm}arm</a></em>, the arm.</p>"
    assert write("# Arm\n\n`arm` [arm](https://a.eu) ![arm](a.png)\n\n- an arm").count(arm) == 1
    assert "<b>" not in write("what <b> is")


def test_the_address_is_that_of_the_row() -> None:
    assert write("Arm").startswith('<p><a href="../glossary.html#')
