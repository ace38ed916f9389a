"""The start page at a glance, and one language of states: worst first, with a word, a margin and a mark in the tree."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen.emit.site import build_site
from archgen.model.project_history import FindingCounts, History, HistoryPoint, ProgressRow
from archgen.pipeline import check_project
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.pages import dashboard, site_pages
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.shapes import Bullets, DashboardCard, Inlines, Page, Paragraph, Table
from archgen.views.timing import chain_status, timing_verdicts
from archgen.views.timing.timing_lookup import analyse_with_chains

ROBOT = """\
partners: {p: {title: Partner P}, q: {}}
requirements: {R-1: Stops in time, R-2: Looks, R-3: Nobody's}
hosts: {pc: {cores: 1, scheduling: fixed_priority}, box: {cores: 1, scheduling: fixed_priority}}
groups:
  g:
    components:
      eye: {owner: p, functionality: Looks., requirements: [R-2], outputs: {o: std_msgs/msg/Bool}}
      brake: {owner: p, functionality: Stops., inputs: {i: eye.o}}
  h:
    components:
      ear: {owner: q, outputs: {o: std_msgs/msg/Bool}}
      mouth: {inputs: {i: ear.o}}
  quiet: {title: Quiet}
nodes:
  eye: {implements: eye, host: pc, timing: {period: 100 ms, wcet: 5 ms, bcet: 5 ms}}
  brake: {implements: brake, host: pc, timing: {behaviour: event, wcet: 5 ms, bcet: 5 ms}}
  ear: {implements: ear, host: box, timing: {period: 1 s, wcet: 1 ms}}
  mouth: {implements: mouth, host: box, timing: {behaviour: event}}
chains:
  free: {title: Free, through: [g.eye, g.brake]}
  roomy: {title: Roomy, through: [g.eye, g.brake], deadline: 10 s}
  tight: {title: Tight, through: [g.eye, g.brake], deadline: 200 ms, requirements: [R-1]}
  owed: {title: Owed, through: [h.ear, h.mouth], deadline: 3 s}
  late: {title: Late, through: [g.eye, g.brake], deadline: 40 ms}
  never: {title: Never, through: [g.eye, g.brake], deadline: 1 ms}
rules: {open-chain: off}
"""


def look_up(folder: Path, robot: str = ROBOT) -> Lookup:
    (folder / "robot.yaml").write_text(robot, encoding="utf-8")
    checked = check_project(folder / "robot.yaml")
    timing = analyse_with_chains(checked.architecture)
    return make_lookup(checked.architecture, checked.findings, timing_lookup=timing)


def read(cell: Inlines) -> str:
    return "".join(run.text for run in cell)


def find_card(cards: tuple[DashboardCard, ...], title: str) -> DashboardCard:
    return next(card for card in cards if card.title == title)


def list_pages(lookup: Lookup) -> dict[str, Page]:
    return {page.anchor: page for page in site_pages.make_pages(lookup, DocumentEdition())}


def test_chains_stand_worst_first_with_verdict_and_margin(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    assert lookup.timing is not None
    chips = {result.id: chain_status.chain_chip(result) for result in lookup.timing.chains}
    assert {name: read(chip) for name, chip in chips.items()} == {
        "never": "missed · >= +9 ms",
        "late": "missed · seen +70 ms",
        "owed": "open · <= 2 s left",
        "tight": "met · 90 ms left",
        "roomy": "met · 9.89 s left",
        "free": "no deadline",
    }
    assert list(chips) == ["never", "late", "owed", "tight", "roomy", "free"]
    assert [chip[0].status for chip in chips.values()] == ["missed", "missed", "open", "met", "met", None]
    table = timing_verdicts.make_bound_table(lookup, lookup.timing)
    assert table is not None
    verdicts = [column.title for column in table.columns].index("Verdict")
    assert [read(row[verdicts]) for row in table.rows] == ["missed", "missed", "open", "met", "met", "no deadline"]


def test_the_figures_say_how_much_and_why_not_more(tmp_path: Path) -> None:
    figures = dashboard.make_dashboard(look_up(tmp_path), DocumentEdition()).figures
    assert [(f.title, f.value, f.total, read(f.note), f.note[0].status, f.ref) for f in figures[1:]] == [
        ("Chains proven in time", "2", "5", "2 missed and 1 open", "missed", "page:chains"),
        ("Requirements served", "2", "3", "R-3 has no component", "uncovered", "page:requirements"),
        ("Components traced", "1", "4", "3 components without a requirement", "uncovered", "page:progress"),
        ("Hosts proven in time", "1", "2", "1 unknown", "open", "page:hosts"),
    ]


def test_a_chain_without_a_deadline_has_no_verdict_also_where_figures_are_missing(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, ROBOT.replace(", deadline: 3 s", ""))
    assert lookup.timing is not None
    owed = next(result for result in lookup.timing.chains if result.id == "owed")
    assert (owed.verdict, owed.bound.complete) == ("open", False)
    assert read(chain_status.verdict_chip(owed)) == "no deadline"
    figure = dashboard.make_dashboard(lookup, DocumentEdition()).figures[1]
    assert (figure.value, figure.total, read(figure.note)) == ("2", "4", "2 missed")
    # Its figures are still missing, and somebody is to write them.
    assert owed in timing_verdicts.list_silent_chains(lookup)


def test_open_points_count_findings_and_the_chains_that_none_is_about(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    board = dashboard.make_dashboard(lookup, DocumentEdition())
    silent_chains = 1  # the open one: the late ones are findings
    assert board.figures[0].value == str(len(lookup.findings) + silent_chains)
    (points,) = find_card(board.cards, "Open points").blocks
    assert isinstance(points, Bullets)
    assert len(points.items) == 4
    uncovered = next(item for item in points.items if item[0].text == "uncovered")
    assert read(uncovered).startswith(
        "uncovered who answers for the requirement R-3?no component and no chain serves the requirement R-3"
    )
    assert "requirement:R-3" in {run.ref for run in uncovered}
    assert uncovered[-1].text == "robot.yaml:2"


def test_of_many_points_and_partners_fewer_are_shown(tmp_path: Path) -> None:
    parts = "".join(f"  g{at}: {{components: {{a: {{owner: p{at % 9}, outputs: {{o: }}}}}}}}\n" for at in range(60))
    partners = ", ".join(f"p{at}: {{}}" for at in range(9))
    lookup = look_up(tmp_path, f"partners: {{{partners}}}\ngroups:\n{parts}")
    cards = dashboard.make_dashboard(lookup, DocumentEdition()).cards
    (points,), (table,) = (find_card(cards, title).blocks for title in ("Open points", "Progress by partner"))
    assert isinstance(points, Bullets)
    assert isinstance(table, Table)
    assert (len(points.items), len(table.rows)) == (3, 6)
    link = find_card(cards, "Progress by partner").link
    assert link
    assert link.text == "3 more, and by group"


def test_partners_with_most_left_to_do_come_first(tmp_path: Path) -> None:
    cards = dashboard.make_dashboard(look_up(tmp_path), DocumentEdition()).cards
    (table,) = find_card(cards, "Progress by partner").blocks
    assert isinstance(table, Table)
    assert [read(row[0]) for row in table.rows] == ["Q", "(nobody)", "Partner P"]
    assert [read(cell) for cell in table.rows[2]] == ["Partner P", "2", " 2", " 2", " 2", " 2", " 1"]


def test_requirements_are_cells_that_link_and_the_uncovered_come_first(tmp_path: Path) -> None:
    cards = dashboard.make_dashboard(look_up(tmp_path), DocumentEdition()).cards
    (cells,) = find_card(cards, "Requirements").blocks
    assert isinstance(cells, Paragraph)
    assert [(run.text, run.ref, run.status) for run in cells.inlines if run.text.strip()] == [
        ("R-3", "requirement:R-3", "uncovered"),
        ("R-1", "requirement:R-1", "met"),
        ("R-2", "requirement:R-2", "met"),
    ]


def test_the_last_changes_are_those_of_the_history(tmp_path: Path) -> None:
    def point(month: int, components: int, warnings: int) -> HistoryPoint:
        row = ProgressRow("project", "p", "P", components, 1, 1, 1, 1, 1, FindingCounts(0, warnings, 0))
        return HistoryPoint("c" * 40, f"2026-{month:02}-01", 1, 1, 3, 3, (row,))

    history = History((point(1, 3, 2), point(2, 4, 2), point(3, 4, 0)), "month")
    cards = dashboard.make_dashboard(look_up(tmp_path), DocumentEdition(history=history)).cards
    (changes,) = find_card(cards, "Last changes").blocks
    assert isinstance(changes, Bullets)
    assert [[run.text for run in item] for item in changes.items] == [
        ["2026-03", "open points 2 → 0"],
        ["2026-02", "components 3 → 4"],
    ]
    assert "Last changes" not in {c.title for c in dashboard.make_dashboard(look_up(tmp_path), DocumentEdition()).cards}


def test_the_tree_marks_what_is_open_and_where_a_deadline_is_missed(tmp_path: Path) -> None:
    pages = list_pages(look_up(tmp_path))
    marks = {anchor: page.mark for anchor, page in pages.items() if page.mark}
    assert marks["group:g"] == marks["page:chains"] == marks["chain:never"] == marks["chain:late"] == "missed"
    assert marks["group:h"] == marks["chain:owed"] == marks["page:findings"] == "open"
    assert not {"group:quiet", "chain:tight", "chain:roomy", "chain:free", "page:index"} & set(marks)
    assert read(pages["chain:tight"].verdict) == "met · 90 ms left"


def test_a_finding_links_what_it_names_its_owner_and_its_rule(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    edition = DocumentEdition(rule_pages={"unread-output": "Because."})
    pages = {page.anchor: page for page in site_pages.make_pages(lookup, edition)}
    table = next(block for block in pages["page:findings"].section.blocks if isinstance(block, Table))
    assert [column.title for column in table.columns] == ["Severity", "Finding", "Owner", "Place", "Rule"]
    row = next(row for row in table.rows if "R-3" in read(row[1]))
    assert [(run.text, run.ref) for run in row[1] if run.ref] == [("R-3", "requirement:R-3")] * 2
    assert (read(row[2]), row[4][0].ref) == ("who answers for the requirement R-3?", "rule:uncovered-requirement")
    owned = next(row for row in table.rows if ("Partner P", "partner:p") in {(run.text, run.ref) for run in row[2]})
    assert {run.ref for run in owned[1]} & {
        "component:g.brake",
        "component:g.eye",
        "chain:late",
        "node:eye",
        "node:brake",
    }
    # The page of a rule that found something; the last point is the chain that no finding is about.
    assert pages["rule:unread-output"].path == "rules/unread-output.html"
    points = pages["page:findings"].section.blocks[-1]
    assert isinstance(points, Bullets)
    assert [(read(item), item[-2].ref) for item in points.items] == [
        ("open · <= 2 s left who answers for the chain owed?Owedexecution time of mouth unknown", "chain:owed")
    ]


def test_counts_of_the_tree_are_those_of_the_statistics(tmp_path: Path) -> None:
    robot = ROBOT + "use_cases: {UC-1: Walks}\ncontainers: {box: {host: pc}}\n"
    pages = tuple(list_pages(look_up(tmp_path, robot)).values())
    files = build_site(pages, {}, title="R", revision="", notices=(), chapter_files=lambda _path: None).files
    html = files["index.html"].decode()
    counts = {
        name: re.findall(
            r'class="count"[^>]*>([^<]*)<', next(re.finditer(rf'<a href="{name}.html">.*?</a>', html)).group()
        )
        for name in ("requirements", "hosts", "nodes", "chains", "findings")
    }
    assert counts == {"requirements": ["3 + 1"], "hosts": ["2 + 1"], "nodes": ["4"], "chains": ["6"], "findings": []}


@pytest.mark.parametrize("robot", ["groups: {}\n", "groups: {g: {}}\n", "groups: {g: {components: {a: {}}}}\n"])
def test_a_project_with_next_to_nothing_has_a_start_page(tmp_path: Path, robot: str) -> None:
    board = list_pages(look_up(tmp_path, robot))["page:index"].dashboard
    assert board is not None
    assert board.figures[0].title == "Open points"
    # The figure says that nothing is open: a card would say it again.
    assert [card.title for card in board.cards] == ["Open points"] * (board.figures[0].value != "0")


def test_the_tree_marks_errors_and_the_figure_warns(tmp_path: Path) -> None:
    wrong = ROBOT.replace("groups:", "groups:\n  wrong: {components: {a: {inputs: {x: nowhere.y}}}}", 1)
    lookup = look_up(tmp_path, wrong)
    marks = {anchor: page.mark for anchor, page in list_pages(lookup).items() if page.mark}
    assert marks["group:wrong"] == marks["page:findings"] == "error"
    assert marks["group:g"] == "missed"
