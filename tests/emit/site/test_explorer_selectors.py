"""Selectors in the explorer's page: the same words mean the same as in the terminal, mistakes and their places included."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.diagnostics.suggestions import find_closest
from archgen.emit.file_tree import write_tree
from archgen.emit.site import build_site
from archgen.model.architecture import Architecture
from archgen.model.selector_evaluation import evaluate_selector
from archgen.model.selector_parser import SELECTOR_KEYS
from archgen.views.explorer import make_explorer_map
from archgen.views.lookup import make_lookup
from archgen.views.shapes import Page, Section
from tests.browser_pages import launch_chromium, sync_playwright
from tests.selector_cases import (
    COMPOSED_FINDINGS,
    COMPOSED_ROBOT,
    COMPOSED_SELECTED,
    FINDINGS,
    FOUND_NOTHING,
    ROBOT,
    SELECTED,
    SELECTED_NODES,
    WRONG,
)

if TYPE_CHECKING:
    from playwright.sync_api import Browser
    from playwright.sync_api import Page as Tab

SELECT = """text => {
  const model = archgenExplorer.readModel();
  const { components, nodes, problems } = archgenExplorer.makeSelector(model)(text);
  return { components: [...components].map(at => model.components[at].id).sort(),
    nodes: [...nodes].map(at => model.nodes[at].id).sort(),
    problems: problems.map(({ message, start, end, severity, help }) => [message, start, end, severity, help]) };
}"""
MORE = (
    "+lidar+ -tag:gpu",
    "2+node:eyes -node:cam",
    "owner:* -owner:tum",
    "type:*image",
    "finding:*",
    "camera.info..executor",
    "sensing..driving",
    "node:cam..base",
    "relay+ cam+1",
    "fusion.any_of+1",
    "stub..odd",
    "medium:digital -role:source",
    'tag:"safety" lidar',
    "owner:certh+1",
    "1+owner:certh",
    "x y,z",
    'package:"',
    "+,",
    "-",
    "a+b+c",
    "Lidar",
    "SENSING.lidar",
    "planing.fusion",
    "000001+fusion",
)
"""Selectors whose meaning the terminal says: forms that meet, which the table has one by one."""


@pytest.fixture(scope="module")
def architecture(derived: Callable[[str], Architecture]) -> Architecture:
    return derived(ROBOT)


@pytest.fixture(scope="module")
def composed(derived: Callable[[str], Architecture]) -> Architecture:
    return derived(COMPOSED_ROBOT)


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = launch_chromium(playwright)
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def tab(browser: Browser, architecture: Architecture, tmp_path_factory: pytest.TempPathFactory) -> Tab:
    """Open the explorer of the robot that the cases are about."""
    return open_explorer(browser, architecture, FINDINGS, tmp_path_factory.mktemp("out") / "site")


@pytest.fixture(scope="module")
def composed_tab(browser: Browser, composed: Architecture, tmp_path_factory: pytest.TempPathFactory) -> Tab:
    """Open the explorer of the robot with components in components."""
    return open_explorer(browser, composed, COMPOSED_FINDINGS, tmp_path_factory.mktemp("out") / "composed")


def open_explorer(
    browser: Browser, architecture: Architecture, ids_by_rule: Mapping[str, frozenset[str]], folder: Path
) -> Tab:
    """Write a site of two pages, and open the explorer."""
    findings = [
        Diagnostic(rule, "", NO_SPAN, Severity.WARNING, element=element)
        for rule, elements in ids_by_rule.items()
        for element in sorted(elements)
    ]
    pages = [
        Page(f"{name}.html", f"page:{name}", name, "overview", Section(f"page:{name}", name))
        for name in ("index", "explorer")
    ]
    tree = build_site(
        pages,
        {},
        title="Robot",
        revision="",
        notices=(),
        chapter_files=lambda _: None,
        explorer_map=make_explorer_map(make_lookup(architecture, findings)),
    )
    write_tree(tree, folder)
    page = browser.new_page()
    page.set_default_timeout(120_000)
    page.goto(f"file://{folder}/explorer.html")
    return page


@pytest.fixture(scope="module")
def select(tab: Tab) -> Callable[[str], Any]:
    """Evaluate a selector in the page."""
    return lambda text: tab.evaluate(SELECT, text)


def test_the_page_knows_all_keys_of_the_language(tab: Tab) -> None:
    assert tab.evaluate("archgenExplorer.grammar.KEYS") == list(SELECTOR_KEYS)


@pytest.mark.parametrize(("text", "selected"), SELECTED)
def test_the_page_selects_the_same_components(
    select: Callable[[str], Any], architecture: Architecture, text: str, selected: str
) -> None:
    answer = select(text)
    assert answer["problems"] == []
    names = [
        c.name if c.group != "driving" else f"d.{c.name}"
        for c in architecture.components.values()
        if c.id in answer["components"]
    ]
    assert " ".join(names) == selected


@pytest.mark.parametrize(("text", "nodes"), SELECTED_NODES)
def test_the_page_selects_the_same_nodes(select: Callable[[str], Any], text: str, nodes: list[str]) -> None:
    answer = select(text)
    assert (answer["nodes"], answer["problems"]) == (nodes, [])


@pytest.mark.parametrize(("text", "problem"), WRONG)
def test_the_page_says_the_same_of_mistakes(select: Callable[[str], Any], text: str, problem: str) -> None:
    answer = select(text)
    ((message, start, end, severity, help_line),) = answer["problems"]
    assert severity == "error"
    assert f"{start}-{end} {message} | {help_line}".startswith(problem)
    assert answer["components"] == answer["nodes"] == []


@pytest.mark.parametrize(("text", "message"), FOUND_NOTHING)
def test_the_page_warns_where_nothing_is_selected(select: Callable[[str], Any], text: str, message: str) -> None:
    answer = select(text)
    assert [f"{start}-{end} {words}" for words, start, end, *_ in answer["problems"]] == [message]
    assert answer["components"] == ["sensing.lidar"]


@pytest.mark.parametrize("text", [*MORE, *(text for text, _ in (*SELECTED, *WRONG, *FOUND_NOTHING))])
def test_terminal_and_page_answer_alike(select: Callable[[str], Any], architecture: Architecture, text: str) -> None:
    selection, problems = evaluate_selector(text, architecture, FINDINGS)
    answer = select(text)
    assert answer["components"] == sorted(selection.components)
    assert answer["nodes"] == sorted(selection.nodes)
    assert answer["problems"] == [[p.message, p.start, p.end, p.severity, p.help] for p in problems]


@pytest.mark.parametrize("text", COMPOSED_SELECTED)
def test_terminal_and_page_answer_alike_of_components_in_components(
    composed_tab: Tab, composed: Architecture, text: str
) -> None:
    selection, problems = evaluate_selector(text, composed, COMPOSED_FINDINGS)
    answer = composed_tab.evaluate(SELECT, text)
    assert answer["components"] == sorted(selection.components)
    assert answer["nodes"] == sorted(selection.nodes)
    assert answer["problems"] == [[p.message, p.start, p.end, p.severity, p.help] for p in problems]


@pytest.mark.parametrize(
    "word", ["fall_detectr", "Object-Recognition", "speling", "ab", "xyz", "spelling", "lel", "a" * 300, "tga", "ownre"]
)
def test_guesses_are_those_of_the_terminal(tab: Tab, word: str) -> None:
    names = ["fall_detector", "object_recognition", "spelling", "ba", "tag", "owner", "level", "a" * 299]
    assert tab.evaluate("([word, names]) => archgenExplorer.findClosest(word, names)", [word, names]) == find_closest(
        word, names
    )
