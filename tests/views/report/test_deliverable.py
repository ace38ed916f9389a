"""The report to hand in: its chapters in short, what partners owe each other, and what stands in data sheets and workbook."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.frozen import replace as replace_frozen
from archgen.model.document_chapters import GENERATED_CHAPTERS
from archgen.products.output_options import OutputOptions
from archgen.products.product_inputs import ProductInputs
from archgen.products.project_views import ProjectViews, make_views
from archgen.views.agreement.exchange_tables import gather_exchanges
from archgen.views.pages.partner_spreads import make_partner_chapter, make_spread_writer
from archgen.views.reliance.partner_impact import find_impact, find_parts_of
from archgen.views.report.data_sheets import make_data_sheets, number_sheets
from archgen.views.report.deliverable import make_deliverable
from archgen.views.report.printed_report import walk_sections
from archgen.views.shapes import Outline, Section, Table
from tests.judged_projects import judge_ramcip
from tests.views.report.report_texts import list_texts

_BENCHMARK = import_module("benchmarks.generate")


@pytest.fixture(scope="module")
def views() -> ProjectViews:
    return make_views(judge_ramcip(), OutputOptions(revision="r", show_history=False), is_report_alone=True)


@pytest.fixture(scope="module")
def deliverable(views: ProjectViews) -> Outline:
    return make_deliverable(views.lookup, replace_frozen(views.edition, document="deliverable"))


def _find(outline: Outline, anchor: str) -> Section:
    return next(section for section in walk_sections(outline.sections) if section.anchor == anchor)


def _tables(section: Section) -> list[Table]:
    return [block for each in walk_sections((section,)) for block in each.blocks if isinstance(block, Table)]


def _read(cell: tuple[object, ...]) -> str:
    return "".join(run.text for run in cell)  # type: ignore[attr-defined]


def test_its_chapters_are_those_of_the_project_and_the_summary_is_first(deliverable: Outline) -> None:
    assert [section.title for section in deliverable.sections] == [
        "Summary",
        "Introduction",
        "Scenarios",
        "Between partners",
        "Use cases",
        "Frames",
        "Deployment and trials",
        "Variants",
        "Hosts and links",
        "Chains of effect",
        "Risks",
        "Requirements, and what proves them",
        "Open points, by who must act",
        "Data sheets and lists",
    ]
    assert not any(section.appendix for section in deliverable.sections)


def test_a_chapter_that_the_project_leaves_out_is_not_there(views: ProjectViews) -> None:
    edition = replace_frozen(views.edition, document="deliverable", chapter_names=("overview", "chains"))
    outline = make_deliverable(views.lookup, edition)
    assert [section.title for section in outline.sections] == ["Summary", "Chains of effect", "Data sheets and lists"]


@pytest.mark.parametrize("name", GENERATED_CHAPTERS)
def test_each_chapter_can_stand_alone(views: ProjectViews, name: str) -> None:
    edition = replace_frozen(views.edition, document="deliverable", chapter_names=(name,))
    outline = make_deliverable(views.lookup, edition)
    anchors = Counter(section.anchor for section in walk_sections(outline.sections))
    assert max(anchors.values()) == 1


def test_each_interface_stands_at_its_giver_and_at_its_taker(views: ProjectViews, deliverable: Outline) -> None:
    given, taken = Counter[str](), Counter[str]()
    for exchange in gather_exchanges(views.lookup):
        for partner in exchange.pair:
            for interface in exchange.interfaces:
                giver, taker = interface.interface.pair
                given[partner] += partner == giver
                taken[partner] += partner == taker
    outputs = {
        partner: len({t.interface.key for e in gather_exchanges(views.lookup) for t in e.list_given(partner)})
        for partner in given
    }
    for partner in given:
        tables = {table.kind: table for table in _tables(_find(deliverable, f"partner:{partner}"))}
        assert len(tables["table:gives"].rows) == outputs[partner] if outputs[partner] else "table:gives" not in tables
        assert len(tables["table:takes"].rows) <= taken[partner]
    forth = {table.kind: table for table in _tables(_find(deliverable, "partner:forth"))}
    first = [_read(cell) for cell in forth["table:gives"].rows[0]]
    assert first[0] == "User answerDialogue Manager"
    assert first[2:] == ["/dialogue/answers", "2\u202fHz", "660", "170", "rate", "QoS"]


def test_what_a_partner_owes_is_what_the_pair_pages_count(views: ProjectViews, deliverable: Outline) -> None:
    owed = Counter[str]()
    for exchange in gather_exchanges(views.lookup):
        for terms in exchange.interfaces:
            owed[terms.interface.pair[0]] += len(terms.open_points)
    sums = next(t for t in _tables(_find(deliverable, "page:partners")) if t.anchor == "table:partner_sums")
    titles = {partner.title: name for name, partner in views.lookup.architecture.partners.items()}
    shown = {titles[_read(row[0])]: _read(row[-1]) for row in sums.rows}
    assert shown == {
        name: f"{owed[name]} term{'s' * (owed[name] != 1)}" if owed[name] else "nothing" for name in titles.values()
    }


def test_requirements_that_nobody_serves_stand_first_and_each_says_its_proof(deliverable: Outline) -> None:
    (table,) = _tables(_find(deliverable, "page:requirements"))
    proofs = [_read(row[-1]) for row in table.rows]
    assert proofs[0] == "nobody serves it"
    assert proofs.count("nobody serves it") == 1
    assert all(proofs)
    kinds = ["chain" if re.match(r"(met|open|missed|not proven) ", proof) else "trial" for proof in proofs[1:]]
    assert kinds == sorted(kinds)
    ids = [_read(row[0]) for row in table.rows]
    assert len(ids) == len(set(ids)) == 29
    assert _read(table.rows[ids.index("R-02")][-1]) == "met 125\u202fms of 350\u202fms"


def test_a_chain_says_its_verdict_and_the_time_of_each_step(views: ProjectViews, deliverable: Outline) -> None:
    timing = views.lookup.timing
    assert timing is not None
    overview = next(t for t in _tables(_find(deliverable, "page:chains")) if t.anchor == "table:chains")
    for result in timing.chains:
        section = _find(deliverable, f"chain:{result.id}")
        assert section.title in {_read(row[0]) for row in overview.rows}
        (table,) = _tables(section)
        assert len(table.rows) == len(result.terms) + 1
        assert next(iter(section.blocks)).inlines[0].text.casefold().startswith(result.verdict)  # type: ignore[union-attr]


def test_every_finding_is_an_open_point_of_somebody(views: ProjectViews, deliverable: Outline) -> None:
    (table,) = _tables(_find(deliverable, "page:findings"))
    said = "\n".join(_read(row[1]).replace("\u202f", " ") for row in table.rows)
    assert [f.message for f in views.lookup.findings if f.message.replace("`", "") not in said] == []
    assert _read(table.rows[0][0])


def test_a_column_of_times_has_one_unit_and_a_table_too(deliverable: Outline) -> None:
    units = {}
    for table in (t for section in deliverable.sections for t in _tables(section)):
        found = {
            column.title.rpartition(", ")[2] for column in table.columns if re.search(r", (s|ms|µs|ns)$", column.title)
        }
        units[table.anchor] = found
    assert {anchor: found for anchor, found in units.items() if len(found) > 1} == {}
    assert sum(map(bool, units.values())) > 20


def test_each_component_has_a_sheet_with_all_its_ports(views: ProjectViews) -> None:
    outline = make_data_sheets(views.lookup, replace_frozen(views.edition, document="data-sheets"))
    sheets = [section for section in walk_sections(outline.sections) if section.anchor.startswith("component:")]
    architecture = views.lookup.architecture
    assert sorted(section.subject for section in sheets) == sorted(architecture.components)
    for section in sheets:
        component = architecture.components[section.subject]
        tables = [table for table in _tables(section) if table.kind in {"table:inputs", "table:outputs"}]
        shown = {_read(row[0]) for table in tables for row in table.rows}
        ports = [_read(row[0]) for table in tables for row in table.rows if _read(row[0]) in component.outputs]
        assert len(ports) == len(set(ports)), f"{section.title}: what is called stands at its port alone"
        assert {*component.inputs, *component.outputs} <= {name.split(" ")[0] for name in shown}, section.title
    numbers = [number for each in number_sheets(views.lookup).values() for number, _ in each]
    assert len(numbers) == len(set(numbers)) == len(sheets)


@pytest.mark.slow
def test_many_flows_are_told_together_and_the_workbook_has_each(tmp_path: Path) -> None:
    _BENCHMARK.generate(400, tmp_path, _BENCHMARK.Amounts(partners=3, chains=4))
    checked = pipeline.check_project(tmp_path)
    views = make_views(checked, OutputOptions(show_history=False), undrawn_kinds=("component",), is_report_alone=True)
    folded, whole = (make_partner_chapter(views.lookup, folds=folds) for folds in (True, False))
    assert folded is not None
    assert whole is not None
    rows = [max(len(table.rows) for table in _tables(chapter)) for chapter in (folded, whole)]
    assert rows[0] <= 44 < rows[1]
    assert "told together with the highest figures. The workbook has each." in "\n".join(list_texts(folded))
    edition = replace_frozen(views.edition, document="deliverable")
    assert len("".join(list_texts(make_deliverable(views.lookup, edition).sections[-1]))) < 12_000


def test_where_each_of_many_requirements_is_met_no_page_is_left_empty(tmp_path: Path) -> None:
    text = "\n".join(
        (
            "hosts: {h: {cores: 1}}",
            "groups: {g: {components: {a: {inputs: {l: {external: x, medium: physical}}, outputs: {o: X}, requirements: [",
            ", ".join(f"R-{at}" for at in range(101)),
            "]}, b: {inputs: {o: a.o}}}}}",
            "nodes: {a: {implements: a, host: h, timing: {rate: 9 Hz, wcet: 1 ms}}, b: {implements: b, host: h, timing: {rate: 9 Hz, wcet: 1 ms}}}",
            "requirements:",
            *(f"  R-{at}: {{title: Thing {at}}}" for at in range(101)),
            f"chains: {{c: {{through: [a, b], deadline: 1 s, requirements: [{', '.join(f'R-{at}' for at in range(101))}]}}}}",
        )
    )
    (tmp_path / "archgen.yaml").write_text(f"{text}\n", encoding="utf-8")
    options = OutputOptions(show_history=False, document="deliverable")
    section = _find(ProductInputs(pipeline.check_project(tmp_path), options).printed_report, "page:requirements")
    assert list(list_texts(section))[-1:] == ["All 101 are served and met. The workbook says what proves each."]
    assert not _tables(section)
    assert not section.page_break


def test_of_many_partners_those_that_have_little_share_pages(tmp_path: Path) -> None:
    _BENCHMARK.generate(40, tmp_path, _BENCHMARK.Amounts(partners=13, chains=2))
    checked = pipeline.check_project(tmp_path)
    views = make_views(checked, OutputOptions(show_history=False), undrawn_kinds=("component",), is_report_alone=True)
    short, whole = (make_partner_chapter(views.lookup, folds=folds) for folds in (True, False))
    assert short is not None
    assert whole is not None
    rows = {}
    for chapter in (short, whole):
        for section in chapter.sections:
            flows = [table for table in _tables(section) if table.kind in {"table:flows", "table:gives", "table:takes"}]
            rows[chapter is short, section.title] = sum(len(table.rows) for table in flows)
    for section in short.sections:
        assert rows[True, section.title] == rows[False, section.title] > 0, "each flow is told in both forms"
        assert len(_tables(section)) <= 2, "what flows, and what is still to be settled"
    writers = [make_spread_writer(views.lookup, folds=folds) for folds in (True, False)]
    assert [writer and writer.is_short for writer in writers] == [True, False]
    first = "\n".join(list_texts(short.sections[0]))
    assert re.search(r"\d components in .*: Component 0\.0, ", first)
    assert re.search(
        r"It rests on Partner 0: .* Deadlines: Chain 0 \(.* are its own, deadline 1000 ms: missed\)", first
    )


def test_of_many_partners_that_share_much_each_has_a_page(tmp_path: Path) -> None:
    _BENCHMARK.generate(250, tmp_path, _BENCHMARK.Amounts(partners=25, chains=50))
    checked = pipeline.check_project(tmp_path)
    views = make_views(checked, OutputOptions(show_history=False), undrawn_kinds=("component",), is_report_alone=True)
    outline = make_deliverable(views.lookup, replace_frozen(views.edition, document="deliverable"))
    for section in _find(outline, "page:partners").sections:
        flows, owes = _tables(section)
        assert (flows.kind, owes.kind) == ("table:flows", "table:owes")
        assert len(flows.rows) <= 16, "eight rows of what it gives, eight of what it takes"
        assert len(owes.rows) <= 7, "four chains, how many more, what it owes and is owed"
        assert len("".join(list_texts(section))) < 4_000
    first = "\n".join(list_texts(_find(outline, "page:partners").sections[0]))
    assert re.search(r"Gives \d+ interfaces; those of one partner, and those of \d+ partners with few, are told", first)
    assert re.search(r"Partner \d+, Partner \d+, Partner \d+ and \d+ more", first), (
        "the last row names some, counts others"
    )
    assert re.search(r"Deadlines: .* and \d+ more\.", first)
    points = _tables(_find(outline, "page:findings"))[0]
    assert max(len(_read(row[2]).split(", ")) for row in points.rows) <= 3, "who waits is counted"


def test_of_many_deadlines_the_worst_stand_in_a_spread_and_the_others_are_counted(tmp_path: Path) -> None:
    _BENCHMARK.generate(80, tmp_path, _BENCHMARK.Amounts(partners=3, chains=56))
    checked = pipeline.check_project(tmp_path)
    views = make_views(checked, OutputOptions(show_history=False), undrawn_kinds=("component",), is_report_alone=True)
    outline = make_deliverable(views.lookup, replace_frozen(views.edition, document="deliverable"))
    deadlines = [each for each in _tables(_find(outline, "page:partners")) if each.kind == "table:deadlines"]
    assert [len(each.rows) for each in deadlines] == [13, 13, 13]
    assert {_read(each.rows[-1][0]) for each in deadlines} == {"44 more stand in the workbook"}
    chapter = _find(outline, "page:chains")
    assert len(next(each for each in _tables(chapter) if each.anchor == "table:chains").rows) == 44
    assert "Of 56 chains the first 16 are told, the first 44 listed; the workbook has all." in "".join(
        list_texts(chapter)
    )
    summary = "".join(list_texts(outline.sections[0]))
    assert "The worst first; 21 more missed, 8 more not proven, 24 more met" in summary, (
        "they were said to have more room"
    )


@pytest.mark.parametrize(
    "source",
    [
        "groups: {}",
        "groups: {g: {components: {c: {}}}}",
        "partners: {a: {}}\ngroups: {g: {owner: a, components: {c: {outputs: [X]}}}}",
        "partners: {a: {}, b: {}}\ngroups: {g: {owner: a, components: {c: {}}}}\nuse_cases: {U: {title: U}}",
    ],
    ids=["nothing", "no partner", "one partner", "nothing between partners"],
)
def test_a_project_without_partners_chains_or_components_has_one(source: str, tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(f"{source}\n", encoding="utf-8")
    checked = pipeline.check_project(tmp_path)
    for document in ("deliverable", "data-sheets"):
        options = OutputOptions(show_history=False, document=document)
        outline = ProductInputs(checked, options).printed_report
        assert "Between partners" not in [section.title for section in outline.sections]
        assert all(block.rows for section in outline.sections for block in _tables(section))


def test_a_part_has_the_chapters_that_a_part_can_have(views: ProjectViews) -> None:
    scope = replace(views.lookup.scope, components=frozenset({"human_state.fall_detector"}), selector_text="x")
    lookup = replace_frozen(views.lookup, scope=scope)
    outline = make_deliverable(lookup, replace_frozen(views.edition, document="deliverable"))
    titles = [section.title for section in outline.sections]
    assert "Chains of effect" not in titles
    assert "Between partners" in titles
    assert [len(each) for each in number_sheets(lookup).values()] == [1]


def test_a_step_whose_time_is_counted_at_another_one_says_so(deliverable: Outline) -> None:
    table = next(
        each for each in _tables(_find(deliverable, "page:chains")) if each.anchor.endswith("missed_dose_to_mark")
    )
    rows = {_read(row[0]): row for row in table.rows}
    assert _read(rows["Risk Estimator"][2]) == "", "it was called 0 ms"
    assert _read(rows["Risk Estimator"][3]) == "counted with Situation Assessment"


def test_what_rests_on_a_partner_is_what_archgen_impact_says(views: ProjectViews, deliverable: Outline) -> None:
    for section in _find(deliverable, "page:partners").sections:
        partner = views.lookup.architecture.partners[section.subject]
        exchanges = gather_exchanges(views.lookup)
        impact = find_impact(views.lookup, exchanges, find_parts_of(views.lookup, partner))
        alone = [each.requirement.id for each in impact.requirements if not each.others]
        words = next(text for text in list_texts(section) if text.startswith("It rests on"))
        assert (f"{len(impact.readers)} components that read from it") in words, "11 stood beside 12"
        assert f"{len(impact.chains)} of 8 deadlines" in words
        assert f"({', '.join(alone)})" in words or not alone, "in the project's order"
