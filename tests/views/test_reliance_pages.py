"""The pages on what rests on a partner and what he has to do: cards, bars, links from his page; and the table of milestones."""

from __future__ import annotations

from pathlib import Path

from archgen.products.agreement_documents import make_timed_lookup
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.views.agreement.exchange_tables import gather_exchanges
from archgen.views.lookup import DocumentScope, Lookup, make_lookup
from archgen.views.pages import partner_pages, reliance_pages
from archgen.views.shapes import Page, Paragraph, Table
from tests.late_robot import ROBOT, check

MILESTONES = "milestones: {m: {title: It sees, date: 2027-03-01, needs: eye}, n: {needs: bed}}\n"


def look_up(folder: Path, text: str = ROBOT) -> Lookup:
    return make_timed_lookup(check(folder, text))


def make_pages(lookup: Lookup) -> dict[str, Page]:
    return {page.anchor: page for page in partner_pages.make_partner_pages(lookup, tuple)}


def test_each_partner_with_components_has_both_and_his_page_leads_there(tmp_path: Path) -> None:
    pages = make_pages(look_up(tmp_path))
    assert {anchor for anchor in pages if anchor.startswith(("late:", "todo:"))} == {
        f"{kind}:{name}" for kind in ("late", "todo") for name in ("north", "south", "west")
    }
    links = [
        run.ref
        for block in pages["partner:north"].section.blocks
        if isinstance(block, Paragraph)
        for run in block.inlines
        if run.ref
    ]
    assert links == ["todo:north", "late:north"]
    assert not any(
        isinstance(block, Paragraph) and len(block.inlines) > 1 for block in pages["partner:idle"].section.blocks
    )
    page = pages["late:north"]
    assert (page.path, page.title, page.crumbs[-1]) == (
        "late/north.html",
        "If North is late",
        ("North", "partner:north"),
    )
    assert page.lead == "2 components · archgen impact --partner north"


def test_cards_hold_the_tables_and_figures_lead_to_them(tmp_path: Path) -> None:
    pages = make_pages(look_up(tmp_path))
    for anchor in ("late:north", "todo:north"):
        dashboard = pages[anchor].dashboard
        assert dashboard is not None
        tables = {block.anchor for card in dashboard.cards for block in card.blocks if isinstance(block, Table)}
        assert {figure.ref for figure in dashboard.figures if "use-cases" not in figure.ref} <= tables
    assert pages["late:north"].waterfall is not None
    assert pages["late:west"].waterfall is None
    # Two pages never share an anchor: links would lead to the first one.
    anchors = [
        block.anchor
        for anchor, page in pages.items()
        for card in (page.dashboard.cards if page.dashboard and anchor.startswith(("late:", "todo:")) else ())
        for block in card.blocks
        if isinstance(block, Table)
    ]
    assert len(anchors) == len(set(anchors))


def test_of_a_part_of_the_project_nothing_is_said(tmp_path: Path) -> None:
    architecture = check(tmp_path).architecture
    lookup = make_lookup(architecture, (), DocumentScope(frozenset({"g.eye"}), frozenset()))
    assert not any(anchor.startswith(("late:", "todo:")) for anchor in make_pages(lookup))


def test_one_partner_and_none(tmp_path: Path) -> None:
    alone = ROBOT.replace("owner: south", "owner: north").replace("owner: west", "owner: north")
    pages = make_pages(look_up(tmp_path, alone))
    assert [figure.title for figure in pages["late:north"].dashboard.figures] == [  # type: ignore[union-attr]
        "Deadlines",
        "Use cases",
        "Requirements",
        "Other components",
    ]
    nobody = "archgen: 1\ngroups: {g: {components: {a: {outputs: {x: std_msgs/msg/Bool}}, b: {inputs: {x: a.x}}}}}\n"
    assert make_pages(look_up(tmp_path, nobody)) == {}


def test_what_others_changed_stands_on_the_page(tmp_path: Path) -> None:
    (tmp_path / "old").mkdir()
    before = ProjectVersion("before", check(tmp_path / "old", ROBOT.replace("period: 100 ms", "period: 50 ms")))
    checked = check(tmp_path / "new")
    comparison = compare_named_versions(before, ProjectVersion("now", checked))
    lookup = make_timed_lookup(checked)
    pages = reliance_pages.make_reliance_pages(lookup, gather_exchanges(lookup), comparison)
    cards = {page.anchor: [card.title for card in page.dashboard.cards] for page in pages if page.dashboard}
    assert "What others changed" in cards["todo:south"]
    assert "What others changed" not in cards["late:south"]


def test_milestones_have_a_table_by_their_days(tmp_path: Path) -> None:
    planned = ROBOT.replace("eye: {implements: eye,", "eye: {implements: eye, status: planned,")
    table = reliance_pages.make_milestone_table(look_up(tmp_path, planned + MILESTONES))
    assert table is not None
    assert table.row_anchors == ("milestone:m", "milestone:n")
    assert [["".join(run.text for run in cell) for cell in row] for row in table.rows] == [
        ["It sees", "2027-03-01", "eye", "1 component", "North", "eye"],
        ["N", "no day named", "bed", "1 component", "", "bed"],
    ]
    assert reliance_pages.make_milestone_table(look_up(tmp_path)) is None
