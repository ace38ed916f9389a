"""The site from memory is the site that is written, and it follows the files."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.products import project_outputs
from archgen.products.output_options import OutputOptions
from archgen.project import ProjectNotFoundError
from archgen.serve.live_site import LiveSite
from tests.serve.conftest import PIXEL, ROBOT


def read_text(live_site: LiveSite, path: str) -> str:
    data = live_site.read_file(path)
    assert data is not None, path
    return data.decode()


def without_live_parts(page: str) -> str:
    assert "connect-src &#39;self&#39;" in page
    page = re.sub(
        r' data-version="[^"]*"', "", page.replace("connect-src &#39;self&#39;", "connect-src &#39;none&#39;")
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
        assert live.list_watched_places().folder is None
        assert live.list_watched_places().files == (file,)
    finally:
        live.stop()


def test_no_project_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ProjectNotFoundError):
        LiveSite(tmp_path / "nothing", OutputOptions())


def test_a_day_of_editing_does_not_fill_the_memory(live_site: LiveSite, robot: Path) -> None:
    for number in range(5):
        (robot / "archgen.yaml").write_text(f"{ROBOT}# {number}\n")
        live_site.refresh()
    assert len(live_site._cache.parsed_slices) == 1  # noqa: SLF001 - nothing else shows it
