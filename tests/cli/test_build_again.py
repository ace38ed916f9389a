"""Building again: what nothing changed of is not made anew, and whatever changed is seen."""

from __future__ import annotations

import shutil
import struct
import zlib
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from archgen.products import full_build, product_writing
from tests.property_sizes import try_some
from tests.running import contents

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from archgen.products.product_inputs import Product, ProductInputs
    from archgen.products.product_writing import StartedProducts
    from tests.cli.conftest import Run

PROJECT = """\
archgen: 1
report: {chapters: [intro.md, overview]}
groups:
  sensing:
    components:
      camera: {outputs: {image: {type: sensor_msgs/msg/Image, external: The recording}}}
"""
SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><rect width="9" height="9"/></svg>'
SAID = "wrote {0}/report.docx\nwrote {0}/site/index.html\nwrote {0}/diagrams\nwrote {0}/packed.yaml\n"


def _png(grey: int) -> bytes:
    """Make a picture of one dot."""

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", zlib.compress(bytes([0, grey]))) + chunk(b"IEND", b"")


class Builds:
    """Builds one project again and again, and counts how often it was made."""

    def __init__(self, run: Run, project: Path, target: Path) -> None:
        self.project, self.target = project, target
        self.made: list[tuple[str, ...]] = []
        """The products that each build made."""
        self._run = run

    @property
    def count(self) -> int:
        """How often anything was made."""
        return sum(1 for products in self.made if products)

    def __call__(self, *words: str) -> int:
        """Build; give how often it was made so far."""
        ran = self._run("build", self.project, "-o", self.target, *words)
        assert (ran.status, ran.err) == (0, "")
        assert ran.out.startswith(SAID.format(self.target))
        return self.count


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give a folder for the pictures that were drawn so far."""
    return tmp_path_factory.mktemp("drawn")


@pytest.fixture
def build(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, drawn: Path) -> Iterator[Builds]:
    project = tmp_path / "robot"
    project.mkdir()
    (project / "archgen.yaml").write_text(PROJECT, "utf-8")
    (project / "intro.md").write_text("Hello ![a plan](plan.svg)\n", "utf-8")
    (project / "plan.svg").write_text(SVG, "utf-8")
    (project / "plan.png").write_bytes(_png(200))
    # Stamps and reports of its own, and the pictures of all: to draw them anew each time would take longer than all else.
    cache = tmp_path / "cache" / "archgen"
    shutil.copytree(drawn, cache)
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache.parent))
    builds = Builds(run, project, tmp_path / "out")
    start = product_writing.start_products

    def recorded(inputs: ProductInputs, products: Sequence[Product]) -> StartedProducts:
        builds.made.append(tuple(product.name for product in products))
        return start(inputs, products)

    monkeypatch.setattr(full_build, "start_products", recorded)
    yield builds
    for picture in cache.glob("*.picture"):
        shutil.copy(picture, drawn)


def test_what_nothing_changed_of_is_not_made_again(build: Builds) -> None:
    assert build() == 1
    before = contents(build.target)
    assert build() == 1
    assert contents(build.target) == before
    assert {"report.docx", "site/index.html", "diagrams/overview.svg", "packed.yaml"} <= set(before)


CHANGES: dict[str, Callable[[Builds], object]] = {
    "a key": lambda b: (b.project / "archgen.yaml").write_text(PROJECT.replace("camera:", "webcam:")),
    "a comment": lambda b: (b.project / "archgen.yaml").write_text(PROJECT + "# why\n"),
    "a chapter": lambda b: (b.project / "intro.md").write_text("Hello\n"),
    "a picture": lambda b: (b.project / "plan.svg").write_text(SVG.replace("9", "8")),
    "a picture beside it": lambda b: (b.project / "plan.png").write_bytes(_png(100)),
    "the report": lambda b: (b.target / "report.docx").write_bytes(b""),
    "the report is gone": lambda b: (b.target / "report.docx").unlink(),
    "a page is gone": lambda b: (b.target / "site" / "index.html").unlink(),
    "the site is gone": lambda b: shutil.rmtree(b.target / "site"),
    "the packed file is a link": lambda b: _linked(b.target / "packed.yaml"),
    "the stamp": lambda b: [stamp.write_bytes(b"{}") for stamp in _stamps(b)],
    "the stamp's half": lambda b: [stamp.write_bytes(stamp.read_bytes()[:40]) for stamp in _stamps(b)],
    "the stamp is a list": lambda b: [stamp.write_bytes(b'{"asked": [], "made": [1]}') for stamp in _stamps(b)],
}


def _linked(file: Path) -> None:
    file.rename(file.with_name("moved"))
    file.symlink_to("moved")


def _stamps(build: Builds) -> list[Path]:
    found = list((build.target.parent / "cache" / "archgen").glob("*.stamp"))
    assert found
    return found


@pytest.mark.parametrize("change", try_some(CHANGES, 4))
def test_whatever_changed_is_seen(build: Builds, change: str) -> None:
    build()
    CHANGES[change](build)
    assert build() == 2
    once = contents(build.target)
    assert build() == 2
    assert contents(build.target) == once


@pytest.mark.parametrize("words", [("--level", "functional"), ("--select", "camera"), ("--revision", "r2")])
def test_what_is_asked_for_is_seen(build: Builds, words: tuple[str, ...]) -> None:
    build()
    assert build(*words) == 2
    assert build(*words) == 2


def test_a_template_is_seen(build: Builds, tmp_path: Path) -> None:
    build()
    template = tmp_path / "house.docx"
    template.write_bytes((build.target / "report.docx").read_bytes())
    assert build("--template", str(template)) == 2
    assert build("--template", str(template)) == 2


def test_another_folder_is_filled(build: Builds, tmp_path: Path) -> None:
    build()
    before = contents(build.target)
    build.target = tmp_path / "elsewhere"
    assert build() == 2
    assert contents(build.target) == before


def test_files_of_others_are_still_refused(run: Run, build: Builds) -> None:
    build()
    (build.target / "site" / "mine.txt").write_text("mine")
    ran = run("build", build.project, "-o", build.target)
    assert ran.status == 2
    assert "holds files that archgen did not write: `mine.txt`" in ran.err


def test_further_backends_are_asked_each_time(build: Builds) -> None:
    build("--backend", "wiki")
    assert build("--backend", "wiki") == 2


def test_what_was_warned_of_is_warned_of_again(run: Run, build: Builds, monkeypatch: pytest.MonkeyPatch) -> None:
    from archgen.emit import graphviz

    def missing(*_: object, **__: object) -> None:
        msg = "no Graphviz here"
        raise graphviz.MissingGraphviz(msg)

    monkeypatch.setattr(graphviz, "draw_pictures", missing)
    for _ in range(2):
        ran = run("build", build.project, "-o", build.target)
        assert (ran.status, ran.err) == (0, "warning: no Graphviz here\n")
    assert build.count == 2


ALL = ("report", "site", "diagrams", "packed")


@pytest.mark.parametrize(
    ("change", "remade"),
    try_some(
        [
            ("the report is gone", ("report",)),
            ("a page is gone", ("site",)),
            ("the packed file is a link", ("packed",)),
            ("a chapter", ALL),
            ("a picture", ("report", "site", "packed")),
            ("a picture beside it", ("report", "packed")),
        ],
        3,
    ),
)
def test_only_what_a_change_concerns_is_made_again(build: Builds, change: str, remade: tuple[str, ...]) -> None:
    build()
    CHANGES[change](build)
    build()
    assert build.made == [ALL, remade]


def test_another_template_concerns_the_report_alone(build: Builds, tmp_path: Path) -> None:
    build()
    template = tmp_path / "house.docx"
    template.write_bytes((build.target / "report.docx").read_bytes())
    build("--template", str(template))
    assert build.made == [ALL, ("report",)]


def test_only_some_are_made_and_the_others_are_not_taken_for_fresh(run: Run, build: Builds) -> None:
    def only(*words: str) -> list[str]:
        ran = run("build", build.project, "-o", build.target, *words)
        assert (ran.status, ran.err) == (0, "")
        return [line.removeprefix(f"wrote {build.target}/") for line in ran.out.splitlines() if "wrote" in line]

    assert only("--only", "packed,report") == ["report.docx", "packed.yaml"]
    assert sorted(contents(build.target)) == ["packed.yaml", "report.docx"]
    (build.project / "intro.md").write_text("Hello\n", "utf-8")
    assert only("--only", "site", "--only", "diagrams") == ["site/index.html", "diagrams"]
    build()
    # The report and the packed file are those of the old chapter.
    assert build.made == [("report", "packed"), ("site", "diagrams"), ("report", "packed")]
    assert only("--only", " site ,") == ["site/index.html"]
    assert build.made[-1] == ()
    assert only("--only", "wiki") == ["wiki"]
    assert only("--only", "report", "--backend", "wiki") == ["report.docx", "wiki"]
    assert only("--only", "wiki", "--backend", "wiki") == ["wiki"]
    assert build.made[-3:] == [("wiki",)] * 3


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("--only", "reprot"), "there is no output `reprot`; did you mean `report`?"),
        (("--only", "site,wikki"), "there is no output `wikki`; did you mean `wiki`?"),
        (("--only", "zzz"), "there is no output `zzz`; there are report, site, diagrams, packed, csv, wiki"),
        (("--only", ","), "--only takes the names of outputs, separated by commas"),
        (("--only", ""), "--only takes the names of outputs, separated by commas"),
        (("--backend", "report"), "there is no text backend `report`; there are csv, wiki"),
    ],
)
def test_a_name_that_is_no_output(run: Run, build: Builds, words: tuple[str, ...], error: str) -> None:
    ran = run("build", build.project, "-o", build.target, *words)
    assert ran.status == 2
    assert ran.err.splitlines()[-1] == f"Error: {error}"
    assert not build.target.exists()


def test_an_output_that_cannot_be_written_costs_no_other(run: Run, build: Builds) -> None:
    (build.target / "site").mkdir(parents=True)
    (build.target / "site" / "mine.txt").write_text("mine")
    ran = run("build", build.project, "-o", build.target)
    written = "".join(f"wrote {build.target}/{name}\n" for name in ("report.docx", "diagrams", "packed.yaml"))
    assert (ran.status, ran.out) == (2, written)
    (build.target / "site" / "mine.txt").unlink()
    build()
    # The stamps of the others were stored although the build failed.
    assert build.made == [ALL, ("site",)]
