"""Links that a stranger's branch brings: nothing is read or written outside of the project by them."""

from __future__ import annotations

import os
import resource
from pathlib import Path

import pytest

from tests.cli.conftest import Run

MANIFEST = "id: leak\ntitle: Leak\nemitter: text\nview: record\nfiles: [{template: environ, path: out.md}]\n"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    folder = tmp_path / "robot"
    folder.mkdir()
    (folder / "archgen.yaml").write_text("archgen: 1\nproject: {id: x}\n", encoding="utf-8")
    (tmp_path / "outside").mkdir()
    return folder


@pytest.mark.parametrize(
    "linked", ["backends", "backends/leak", "backends/leak/templates", "backends/leak/backend.yaml"]
)
def test_a_backend_is_not_reached_by_links(run: Run, project: Path, linked: str) -> None:
    outside = project.parent / "outside" / "leak"
    (outside / "templates").mkdir(parents=True)
    (outside / "templates" / "environ").write_text("secret", encoding="utf-8")
    (outside / "backend.yaml").write_text(MANIFEST, encoding="utf-8")
    target = {"backends": outside.parent, "backends/leak": outside}.get(linked, outside / Path(linked).name)
    if linked.count("/") == 2:
        (project / "backends" / "leak" / "templates").mkdir(parents=True)
        (project / "backends" / "leak" / "templates" / "environ").write_text("own", encoding="utf-8")
        (project / "backends" / "leak" / "backend.yaml").write_text(MANIFEST, encoding="utf-8")
        place = project / linked
        if place.is_dir():
            (place / "environ").unlink()
            place.rmdir()
        else:
            place.unlink()
    else:
        (project / linked).parent.mkdir(parents=True, exist_ok=True)
    (project / linked).symlink_to(target)
    ran = run("build", project, "--only", "leak", "--backend", "leak")
    assert ran.status != 0
    assert f"`{linked}` is a link" in ran.out + ran.err
    assert not (project / "archgen-out" / "leak").exists()


@pytest.mark.parametrize("linked", ["archgen-out", "archgen-out/site", "archgen-out/packed.yaml"])
def test_outputs_are_not_led_out_of_the_project(run: Run, project: Path, linked: str) -> None:
    outside = project.parent / "outside"
    (outside / "packed.yaml").write_text("mine", encoding="utf-8")
    (project / linked).parent.mkdir(exist_ok=True)
    (project / linked).symlink_to(outside / "packed.yaml" if linked.endswith(".yaml") else outside)
    for words in (("build", project, "--only", "site,packed"), ("pack", project), ("site", project)):
        ran = run(*words)
        led_out = linked == "archgen-out" or words[0] in {"build", linked.rpartition("/")[2].removesuffix("ed.yaml")}
        assert (ran.status != 0) is led_out, (words, ran.err)
        assert not led_out or "is reached by a link that leads out of the project" in ran.err
    assert {path.name: path.read_text() for path in outside.iterdir()} == {"packed.yaml": "mine"}


def test_a_folder_that_is_named_is_where_it_is_wanted(run: Run, project: Path) -> None:
    (project / "elsewhere").symlink_to(project.parent / "outside")
    assert run("pack", project, "-o", project / "elsewhere" / "x.yaml").status == 0
    assert (project.parent / "outside" / "x.yaml").exists()


@pytest.mark.parametrize("words", [("timing", "--measured"), ("report", "--template")])
def test_a_file_that_never_ends_is_not_read(run: Run, project: Path, words: tuple[str, str]) -> None:
    os.mkfifo(project / "pipe.docx")
    (project / "zero.docx").symlink_to("/dev/zero")
    for name, reason in (("pipe.docx", "this is a named pipe"), ("zero.docx", "this is a device")):
        ran = run(words[0], project, words[1], project / name)
        assert ran.status == 2
        assert reason in ran.err


@pytest.mark.parametrize("name", ["site/.archgen-files", "site/index.html", "report.docx", "packed.yaml"])
def test_a_huge_file_in_the_place_of_an_output_is_not_read(run: Run, project: Path, name: str) -> None:
    assert run("build", project, "--only", "site,report,packed").status == 0
    place = project / "archgen-out" / name
    with place.open("r+b") as stream:
        stream.truncate(3_000_000_000)  # a hole: no block of the disk is used
    _, hard_limit = resource.getrlimit(resource.RLIMIT_AS)
    used_bytes = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used_bytes + 1_500_000_000, hard_limit))
    try:
        ran = run("build", project, "--only", "site,report,packed")
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (hard_limit, hard_limit))
    assert "mistake in archgen" not in ran.err
    assert place.exists()
