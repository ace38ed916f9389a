"""The printed report says all that the outline says: what it says elsewhere or shorter is on a list with the reasons."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from archgen.products.output_options import OutputOptions
from archgen.products.project_views import ProjectViews, make_views
from archgen.views.pages import report_outline
from archgen.views.report.printed_figures import print_inlines, print_text
from archgen.views.report.printed_report import make_printed_report, walk_sections
from archgen.views.shapes import Outline, Paragraph, Section, Table, Text
from tests.judged_projects import judge_ramcip
from tests.property_sizes import try_some
from tests.views.report.report_texts import list_block_texts, list_texts

LIST = yaml.safe_load((Path(__file__).parent / "said_elsewhere.yaml").read_text(encoding="utf-8"))
REWRITTEN = [(re.compile(entry["text"]), entry["becomes"]) for entry in LIST["rewritten"]]
GONE = [re.compile(entry["text"]) for entry in LIST["gone"]]


@pytest.fixture(scope="module")
def views() -> ProjectViews:
    checked = judge_ramcip()
    return make_views(checked, OutputOptions(revision="r", show_history=False))


def _normalize(text: str) -> str:
    # Figures are rounded and written with real signs in one of the two: `tests/views/report/test_printed_figures.py`.
    text = "".join(run.text for run in print_inlines((Text(print_text(text)),))).replace("\u202f", " ")
    for pattern, becomes in REWRITTEN:
        text = pattern.sub(becomes, text)
    # `Rate` is a name of its own in one document and stands inside of a sentence in the other.
    return " ".join(text.split()).casefold()


def _list_lost(before: Iterable[str], after: Iterable[str]) -> list[str]:
    """Return the texts from before that no text of after holds, without those on the list."""
    blob = "\n".join(dict.fromkeys(_normalize(text) for text in after))
    lost = dict.fromkeys(text for text in map(_normalize, before) if text not in blob)
    return [text for text in lost if not any(pattern.fullmatch(text) for pattern in GONE)]


def _list_all(outline: Outline) -> list[str]:
    texts = [text for section in (*outline.front_sections, *outline.sections) for text in list_texts(section)]
    texts += [text for name, value in outline.facts for text in (name, *(part.text for part in value))]
    return texts + (list(list_block_texts(outline.title_table)) if outline.title_table else [])


@pytest.mark.slow
@pytest.mark.parametrize("ros_place", try_some(["annex", "inline"]))
def test_nothing_is_lost_with_everything(views: ProjectViews, ros_place: str) -> None:
    edition = replace(views.edition, ros_place=ros_place)  # type: ignore[arg-type]
    before = report_outline.make_report(views.lookup, edition)
    after = make_printed_report(views.lookup, edition)
    assert _list_lost(_list_all(before), _list_all(after)) == []


def test_nothing_is_lost_of_the_functional_level(views: ProjectViews) -> None:
    edition = replace(views.edition, level="functional")
    before = report_outline.make_report(views.lookup, edition)
    after = make_printed_report(views.lookup, edition)
    assert _list_lost(_list_all(before), _list_all(after)) == []


def test_nothing_of_a_component_moves_to_another(views: ProjectViews) -> None:
    before = report_outline.make_report(views.lookup, views.edition)
    after = make_printed_report(views.lookup, views.edition)
    sections = {section.anchor: section for section in walk_sections(after.sections)}
    # The chapter's heading says the group of each component.
    shared = [
        *list_texts(sections["page:parameters"]),
        *(group.title for group in views.lookup.architecture.groups.values()),
    ]
    lost: dict[str, list[str]] = {}
    for section in walk_sections(before.sections):
        kind, _, component = section.anchor.partition(":")
        if kind == "component":
            parts = [sections[section.anchor], sections.get(f"implementation:{component}", Section("", ""))]
            texts = [text for part in parts for text in list_texts(part)]
            lost[component] = _list_lost(list_texts(section), [*texts, *shared])
    assert {name: texts for name, texts in lost.items() if texts} == {}


def test_groups_have_what_they_serve_and_views_what_flows_in_them(views: ProjectViews) -> None:
    printed = make_printed_report(views.lookup, views.edition)
    sections = {section.anchor: section for section in walk_sections(printed.sections)}
    titles = [block.inlines[0].text for block in sections["group:human_state"].blocks if isinstance(block, Paragraph)]
    assert titles[1:] == ["Requirements", "Chains through it", "Who to talk to"]
    assert [block.kind for block in sections["view:safety"].blocks if isinstance(block, Table)] == ["table:flows"]


@pytest.mark.slow
def test_every_entry_of_the_list_is_needed_and_says_why(views: ProjectViews) -> None:
    texts = _list_all(report_outline.make_report(views.lookup, views.edition))
    assert [
        entry["text"] for entry in LIST["gone"] if not any(re.fullmatch(entry["text"], _normalize(t)) for t in texts)
    ] == []
    assert [entry["text"] for part in LIST.values() for entry in part if len(entry["why"]) < 20] == []
