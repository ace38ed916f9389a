"""The site from memory is the site that is written, and it follows the files."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import BinaryIO

import pytest

from archgen.pipeline import UnknownVariantError, check_project
from archgen.products import project_outputs
from archgen.products.comparison_documents import compare_since
from archgen.products.output_options import OutputOptions
from archgen.products.project_views import select_elements
from archgen.project import ProjectNotFoundError
from archgen.regular_files import open_named_file
from archgen.serve.live_site import LiveSite
from archgen.serve.project_state import SelectionError
from tests.repositories import commit, git
from tests.serve.conftest import PIXEL, ROBOT


def read_text(live_site: LiveSite, path: str) -> str:
    data = live_site.read_file(path)
    assert data is not None, path
    return data.decode()


def without_live_parts(page: str) -> str:
    assert "connect-src &#x27;self&#x27;" in page
    page = re.sub(
        r' data-version="[^"]*"', "", page.replace("connect-src &#x27;self&#x27;", "connect-src &#x27;none&#x27;")
    )
    return re.sub(r"<(?:link|script)[^>]*live/live[^>]*>(?:</script>)?\n", "", page)


def test_each_file_of_the_written_site_is_served_as_it_is(live_site: LiveSite, robot: Path, tmp_path: Path) -> None:
    project_outputs.write_site(check_project(robot), OutputOptions(), tmp_path / "site")
    files = {
        path.relative_to(tmp_path / "site").as_posix(): path
        for path in (tmp_path / "site").rglob("*")
        if path.is_file() and path.name != ".archgen-files"
    }
    assert {"index.html", "components/g.eye.html", "assets/search/index.js", "figures/overview.svg"} <= files.keys()
    for name, path in files.items():
        data = live_site.read_file(name)
        assert data is not None, name
        if name.endswith(".html"):
            assert without_live_parts(data.decode()) == path.read_text(), name
        else:
            assert data == path.read_bytes(), name


@pytest.mark.parametrize(
    "path",
    ["", "components", "components/", "archgen.yaml", "../robot/archgen.yaml", "/etc/passwd", "pictures/../x.png"],
)
def test_nothing_else_is_served(live_site: LiveSite, path: str) -> None:
    assert live_site.read_file(path) is None


def test_a_picture_of_a_chapter_is_served_before_its_page(live_site: LiveSite) -> None:
    assert live_site.read_file("pictures/docs/dot.png") == PIXEL


def test_a_change_is_on_the_pages_and_in_the_search(live_site: LiveSite, robot: Path) -> None:
    assert "Sees." not in read_text(live_site, "components/g.eye.html")
    version = live_site.status.version
    changed = ROBOT.replace("Looks.", "Sees.").replace("      brake:", "      horn: {outputs: {x: Honk}}\n      brake:")
    (robot / "archgen.yaml").write_text(changed)
    live_site.refresh()
    assert live_site.status.version != version
    assert "Sees." in read_text(live_site, "components/g.eye.html")
    assert "Honk" in read_text(live_site, "components/g.horn.html")
    assert "g.horn" in "".join(read_text(live_site, f"assets/search/{name}.js") for name in ("component-1", "index"))
    (robot / "archgen.yaml").write_text(ROBOT)
    live_site.refresh()
    assert live_site.read_file("components/g.horn.html") is None


def test_a_figure_of_timing_that_changes_changes_the_chain(live_site: LiveSite, robot: Path) -> None:
    assert "met" in read_text(live_site, "chains/stop.html")
    (robot / "archgen.yaml").write_text(ROBOT.replace("deadline: 200 ms", "deadline: 4 ms"))
    live_site.refresh()
    assert "missed" in read_text(live_site, "chains/stop.html")


def test_what_cannot_be_read_is_told_and_the_last_sound_state_stays(live_site: LiveSite, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(
        ROBOT.replace("Looks.", "Sees.").replace("inputs: {i: eye.o}", "imputs: {i: eye.o}")
    )
    live_site.refresh()
    status = live_site.status
    (note,) = status.errors
    assert note["place"].startswith("archgen.yaml:10:")
    assert "imputs" in note["message"]
    assert "inputs" in note["help"]
    assert note["line"].startswith("      brake:")
    assert status.is_outdated
    assert "Looks." in read_text(live_site, "components/g.eye.html")
    (robot / "archgen.yaml").write_text(ROBOT.replace("Looks.", "Sees."))
    live_site.refresh()
    assert live_site.status.errors == ()
    assert not live_site.status.is_outdated
    assert "Sees." in read_text(live_site, "components/g.eye.html")


def test_a_project_that_is_broken_from_the_start_shows_what_is_sound(robot: Path) -> None:
    (robot / "archgen.yaml").write_text(ROBOT.replace("inputs: {i: eye.o}", "inputs: {i: nose.o}"))
    live = LiveSite(robot, OutputOptions())
    live.start()
    try:
        assert len(live.status.errors) == 1
        assert "has errors" in read_text(live, "index.html")
    finally:
        live.stop()


def test_a_project_that_is_gone_is_told_and_comes_back(live_site: LiveSite, robot: Path) -> None:
    text = (robot / "archgen.yaml").read_text()
    (robot / "archgen.yaml").unlink()
    live_site.refresh()
    assert len(live_site.status.errors) == 1
    assert "Robot" in read_text(live_site, "index.html")
    (robot / "archgen.yaml").write_text(text)
    live_site.refresh()
    assert live_site.status.errors == ()


def test_a_project_of_one_file_is_served(robot: Path) -> None:
    file = robot / "single.yaml"
    file.write_text("groups: {g: {title: Alone, components: {a: {}}}}\n")
    live = LiveSite(file, OutputOptions())
    live.start()
    try:
        assert "Alone" in read_text(live, "groups/g.html")
        assert live.list_watched_places().folders == ()
        assert live.list_watched_places().files == (file,)
    finally:
        live.stop()


def test_a_library_is_watched_too(robot: Path) -> None:
    library = robot / "lib" / "a.yaml"
    library.parent.mkdir()
    library.write_text("component_types: {lamp: {}}\n")
    (robot / "archgen.yaml").write_text(f"{ROBOT}libraries: {{common: lib}}\n")
    live = LiveSite(robot, OutputOptions())
    live.refresh()
    assert live.list_watched_places().folders == (robot, robot / "lib")
    assert library in live.list_watched_places().files


def test_no_project_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ProjectNotFoundError):
        LiveSite(tmp_path / "nothing", OutputOptions())


def test_a_day_of_editing_does_not_fill_the_memory(live_site: LiveSite, robot: Path) -> None:
    for number in range(5):
        (robot / "archgen.yaml").write_text(f"{ROBOT}# {number}\n")
        live_site.refresh()
    assert len(live_site._project.cache.parsed_slices) == 1  # noqa: SLF001 - nothing else shows it


@pytest.mark.parametrize("selector", ["", "g.eye"])
def test_changes_and_a_selection_are_served_as_they_are_written(robot: Path, tmp_path: Path, selector: str) -> None:
    git(robot, "init", "-q", "-b", "main")
    commit(robot, {})
    (robot / "archgen.yaml").write_text(ROBOT.replace("Looks.", "Sees."))
    checked = check_project(robot)
    selection = select_elements(checked, selector)[0] if selector else None
    changes = compare_since("HEAD", robot, checked)
    options = OutputOptions(selection, selector, show_history=False, changes=changes)
    project_outputs.write_site(checked, options, tmp_path / "site")
    live = LiveSite(robot, OutputOptions(selector_text=selector, show_history=False), "HEAD")
    live.start()
    try:
        for name in ("index.html", "changes.html", "components/g.eye.html", "groups/g.html"):
            # Served pages ask git when nobody waits: the revision may stand there by now, or not yet.
            revision = r'<span class="revision">.*</span>\n|<div><dt>Revision</dt>.*\n'
            written = re.sub(revision, "", (tmp_path / "site" / name).read_text())
            served = re.sub(revision, "", without_live_parts(read_text(live, name)))
            assert served == written, name
        assert "since HEAD</span>" in read_text(live, "components/g.eye.html")
        for picture in ("figures/overview.svg", "figures/components-g.eye.svg"):
            file = tmp_path / "site" / picture
            assert live.read_file(picture) == (file.read_bytes() if file.exists() else None), picture
    finally:
        live.stop()


def test_what_changes_while_it_is_served_is_marked(robot: Path) -> None:
    git(robot, "init", "-q", "-b", "main")
    commit(robot, {})
    live = LiveSite(robot, OutputOptions(), "HEAD")
    live.start()
    try:
        assert "since HEAD" not in read_text(live, "components/g.eye.html")
        (robot / "archgen.yaml").write_text(ROBOT.replace("Looks.", "Sees."))
        live.refresh()
        assert "Sees." in read_text(live, "components/g.eye.html")
        # The comparison comes when nobody waits.
        given_up_at = time.monotonic() + 120
        while "since HEAD</span>" not in read_text(live, "components/g.eye.html"):
            assert time.monotonic() < given_up_at
            live.wait_for_news(live.status.version, 1.0)
    finally:
        live.stop()


def test_a_selector_that_names_nothing_any_more_leaves_the_last_state(robot: Path) -> None:
    live = LiveSite(robot, OutputOptions(selector_text="g.eye"))
    live.start()
    try:
        (robot / "archgen.yaml").write_text(ROBOT.replace("eye", "ear").replace("Looks", "Hears"))
        live.refresh()
        (note,) = live.status.errors
        assert "eye" in note["message"]
        assert "Looks." in read_text(live, "components/g.eye.html")
    finally:
        live.stop()


def test_a_selector_that_names_nothing_at_the_start_is_an_error(robot: Path) -> None:
    live = LiveSite(robot, OutputOptions(selector_text="g.nose"))
    with pytest.raises(SelectionError, match="nose"):
        live.start()
    live.stop()


def test_a_variant_is_served_until_it_is_gone(robot: Path) -> None:
    variants = "variants: {dark: {changes: {groups: {g: {title: In the dark}}}}}\n"
    (robot / "archgen.yaml").write_text(f"{ROBOT}{variants}")
    live = LiveSite(robot, OutputOptions(), variants=("dark",))
    live.start()
    try:
        assert "In the dark" in read_text(live, "groups/g.html")
        (robot / "archgen.yaml").write_text(ROBOT)
        live.refresh()
        assert "no variant named `dark`" in live.status.errors[0]["message"]
        assert "In the dark" in read_text(live, "groups/g.html")
    finally:
        live.stop()


def test_a_variant_that_is_not_there_is_not_served(robot: Path) -> None:
    live = LiveSite(robot, OutputOptions(), variants=("bright",))
    with pytest.raises(UnknownVariantError):
        live.start()
    live.stop()


@pytest.mark.parametrize(
    "change", [Path.unlink, lambda file: file.write_text("groups: [")], ids=["gone", "half written"]
)
def test_files_that_change_while_they_are_read_are_read_again(
    live_site: LiveSite, robot: Path, change: Callable[[Path], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    """At each file that a refresh opens; the next refresh shows what is there then."""
    opened = list[Path]()
    harmed_step = -1

    def open_late(path: Path, *flags: int) -> AbstractContextManager[BinaryIO]:
        opened.append(path)
        if len(opened) == harmed_step:
            change(path)
        return open_named_file(path, *flags)

    monkeypatch.setattr("archgen.syntax.folder_files.open_named_file", open_late)
    files = {file: file.read_bytes() for file in robot.rglob("*") if file.is_file()}
    live_site.refresh()
    page = without_live_parts(read_text(live_site, "groups/g.html"))
    count = len(opened)
    assert count > 0
    for step in range(1, count + 1):
        harmed_step = step
        opened.clear()
        live_site.refresh()
        for file, data in files.items():
            file.write_bytes(data)
        harmed_step = -1
        live_site.refresh()
        assert without_live_parts(read_text(live_site, "groups/g.html")) == page
