"""Single outputs, as the verbs and the API ask for them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest
import yaml

from archgen.emit.file_tree import OutputError
from archgen.pipeline import CheckedProject, check_project
from archgen.products import full_build, product_inputs, product_writing, project_outputs, workspace_product
from archgen.products.output_options import OutputOptions
from archgen.products.product_table import PRODUCTS
from archgen.products.product_writing import DrawnPictures
from archgen.views import drawing_set
from archgen.views.picture_shapes import Drawing


@pytest.fixture
def project(tmp_path: Path) -> CheckedProject:
    (tmp_path / "archgen.yaml").write_text(
        "archgen: 1\nproject: {id: rover}\ngroups: {g: {components: {a: {outputs: {o: T}}, b: {inputs: {i: a.o}}}}}\n",
        encoding="utf-8",
    )
    return check_project(tmp_path)


def test_the_packed_and_the_resolved_file_are_yaml(project: CheckedProject, tmp_path: Path) -> None:
    project_outputs.write_packed(project, tmp_path / "out" / "packed.yaml")
    assert yaml.safe_load((tmp_path / "out" / "packed.yaml").read_text())["project"]["id"] == "rover"
    assert list(yaml.safe_load(project_outputs.render_resolved(project, OutputOptions()))["components"]) == [
        "g.a",
        "g.b",
    ]


def test_the_site_has_a_page_for_each_component(project: CheckedProject, tmp_path: Path) -> None:
    project_outputs.write_site(project, OutputOptions(show_history=False), tmp_path / "site")
    assert {file.name for file in (tmp_path / "site" / "components").rglob("*.html")} == {"g.a.html", "g.b.html"}


def list_component_pictures(site: Path) -> list[str]:
    return sorted(file.relative_to(site).as_posix() for file in (site / "figures").rglob("g.*.svg"))


@pytest.mark.parametrize(("wish", "most"), [(False, 300), (None, 1)])
def test_a_large_site_has_no_picture_of_each_component(
    *, project: CheckedProject, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, wish: bool | None, most: int
) -> None:
    monkeypatch.setattr(drawing_set, "MAX_PICTURED_COMPONENTS", most)
    options = OutputOptions(show_history=False, component_pictures=wish)
    project_outputs.write_site(project, options, tmp_path / "site")
    assert list_component_pictures(tmp_path / "site") == []
    assert "could not be drawn" not in (tmp_path / "site" / "components" / "g.a.html").read_text()
    # A build that draws them for the report leaves the site as it is alone.
    inputs = product_inputs.ProductInputs(project, options)
    full_build.build_outputs(inputs, (PRODUCTS["site"], PRODUCTS["diagrams"]), tmp_path / "build")
    assert list_component_pictures(tmp_path / "build" / "site") == []
    assert (tmp_path / "build" / "diagrams" / "components" / "g.a.svg").exists()


def test_a_site_beside_a_report_links_it_from_each_page(project: CheckedProject, tmp_path: Path) -> None:
    inputs = product_inputs.ProductInputs(project, OutputOptions(show_history=False))
    start, component = tmp_path / "site" / "index.html", tmp_path / "site" / "components" / "g.a.html"
    link = '<a class="report" href="{}report.docx">Report</a>'
    for names, is_linked in (("site", False), ("report site", True), ("site", True)):
        full_build.build_outputs(inputs, [PRODUCTS[name] for name in names.split()], tmp_path)
        assert (link.format("../") in start.read_text()) is is_linked
        assert (link.format("../../") in component.read_text()) is is_linked


def test_no_picture_is_drawn_in_a_format_that_nobody_shows_it_in(
    project: CheckedProject, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Mapping[str, Sequence[str]]] = []

    def note_formats(drawings: Sequence[Drawing], formats: Mapping[str, Sequence[str]], *_: object) -> DrawnPictures:
        assert [each.id for each in drawings] == list(formats)
        asked.append(formats)
        return DrawnPictures()

    monkeypatch.setattr(product_writing, "_draw_started_pictures", note_formats)
    inputs = product_inputs.ProductInputs(project, OutputOptions(show_history=False))
    product_writing.start_products(inputs, (PRODUCTS["site"], PRODUCTS["report"]))
    site_names, report_names = set(inputs.site_drawings), set(PRODUCTS["report"].list_drawings(inputs))
    assert site_names - report_names
    assert site_names & report_names
    for name, formats in asked[0].items():
        expected = {"svg"} if name in site_names else set()
        assert set(formats) == expected | ({"svg_outlines", "png"} if name in report_names else set()), name


@pytest.mark.parametrize(("wish", "most"), [(True, 1), (None, 2)])
def test_a_site_has_pictures_of_components_up_to_a_number_or_as_asked(
    *, project: CheckedProject, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, wish: bool | None, most: int
) -> None:
    monkeypatch.setattr(drawing_set, "MAX_PICTURED_COMPONENTS", most)
    project_outputs.write_site(project, OutputOptions(show_history=False, component_pictures=wish), tmp_path / "site")
    assert list_component_pictures(tmp_path / "site")[:2] == [
        "figures/components/g.a.svg",
        "figures/components/g.b.svg",
    ]


def test_pages_say_that_their_picture_is_left_out_for_its_number(
    project: CheckedProject, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drawing_set, "MAX_PICTURED_COMPONENTS", 1)
    monkeypatch.setattr(drawing_set, "MAX_PICTURED_GROUPS", 0)
    project_outputs.write_site(project, OutputOptions(show_history=False), tmp_path / "site")
    assert not (tmp_path / "site" / "figures" / "groups").exists()
    for page in ("groups/g.html", "components/g.a.html"):
        html = (tmp_path / "site" / page).read_text()
        assert html.count("No picture is drawn here") == 1
        assert '<a href="../explorer.html">explorer</a>' in html
        assert "could not be drawn" not in html
    # Who asks for them gets them, and no such words.
    options = OutputOptions(show_history=False, component_pictures=True)
    project_outputs.write_site(project, options, tmp_path / "all")
    assert (tmp_path / "all" / "figures" / "groups" / "g.svg").exists()
    assert "No picture" not in (tmp_path / "all" / "groups" / "g.html").read_text()


def test_timing_of_groups_is_left_out_with_pictures_of_components_unless_they_are_asked_for() -> None:
    assert drawing_set.list_undrawn_kinds(300, 200, wish=None) == frozenset()
    assert drawing_set.list_undrawn_kinds(301, 200, wish=None) == {"component", "implementation", "group-timing"}
    assert drawing_set.list_undrawn_kinds(301, 200, wish=True) == frozenset()
    # Who wants no pictures of components in a small site keeps those of groups.
    assert drawing_set.list_undrawn_kinds(300, 200, wish=False) == {"component", "implementation"}
    assert drawing_set.list_undrawn_kinds(2, 201, wish=None) == {"group", "group-timing"}


def test_a_site_with_kept_pictures_has_the_bytes_of_a_fresh_one(
    project: CheckedProject, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "kept"))
    options = OutputOptions(show_history=False)
    project_outputs.write_site(project, options, tmp_path / "site")
    file = tmp_path / "archgen.yaml"
    file.write_text(file.read_text().replace("a: {", "a: {title: Eye, description: It sees., "))
    changed_project = check_project(tmp_path)
    project_outputs.write_site(changed_project, options, tmp_path / "site")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "empty"))
    project_outputs.write_site(changed_project, options, tmp_path / "fresh")
    kept, fresh = (
        {f.relative_to(top): f.read_bytes() for f in top.rglob("*") if f.is_file()}
        for top in (tmp_path / "site", tmp_path / "fresh")
    )
    assert kept == fresh
    assert b"Eye" in kept[Path("components/g.a.html")]


def test_a_picture_that_nobody_knows_is_an_error_and_nothing_is_written(
    project: CheckedProject, tmp_path: Path
) -> None:
    with pytest.raises(OutputError, match="no picture is called nowhere"):
        project_outputs.write_diagrams(project, OutputOptions(), tmp_path / "pictures", ("svg",), ("nowhere",))
    assert not (tmp_path / "pictures").exists()


def test_a_workspace_asks_for_a_backend_that_makes_one(project: CheckedProject) -> None:
    with pytest.raises(OutputError, match="wiki"):
        workspace_product.write_workspace(project, OutputOptions(), "wiki")
