"""A project whose every text tries to be more than text, through every verb and into every output."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import re
import shutil
import zipfile
from collections.abc import Callable, Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
import yaml
from click.testing import CliRunner
from lxml import etree
from markdown_it import MarkdownIt

from archgen.cli import main as verbs
from archgen.cli.list_command import LISTABLE_KINDS
from tests import hostile
from tests.browser_pages import launch_chromium, sync_playwright
from tests.emit.docx import inspection, judges
from tests.findings import judges as servers
from tests.judged_projects import judge_shipped_once
from tests.property_sizes import DRAWS_ANEW, try_some
from tests.running import archgen_here, contents, made_once

if TYPE_CHECKING:
    from playwright.sync_api import Dialog

WORDS = tuple(hostile.TEXTS)
SHOWN_PAGES = 2
SCHEMES = {"http", "https", "mailto"}
ACTIVE = {"script", "iframe", "object", "embed", "base", "form", "foreignobject", "animate", "set", "math", "style"}


@pytest.fixture(scope="module", params=try_some(WORDS))
def kind(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def project(kind: str, tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Path:
    """Write the project and build everything from it, in `out` beside it; give its folder."""
    base = tmp_path_factory.getbasetemp()
    place = base if worker_id == "master" else base.parent
    return made_once(place / f"hostile-{kind}", lambda folder: make(folder, hostile.TEXTS[kind])) / "project"


def make(folder: Path, text: str) -> None:
    (folder / "project").mkdir(parents=True)
    (folder / "project" / "archgen.yaml").write_text(hostile.written(hostile.project(text)), encoding="utf-8")
    outputs = ("--backend", "wiki", "--revision", text[:80].replace("\0", ""), "-o", "../out")
    done = archgen_here("build", *outputs, cwd=folder / "project", env={"XDG_CACHE_HOME": str(folder / "cache")})
    (folder / "said.txt").write_bytes(done.stdout + done.stderr)
    archgen_here("report", "--document", "full", "-o", "../out/full.docx", cwd=folder / "project")


def files(project: Path, ending: str) -> Iterator[tuple[str, bytes]]:
    found = contents(project.parent / "out")
    assert any(path.endswith(ending) for path in found)
    return ((path, data) for path, data in found.items() if path.endswith(ending))


def said(project: Path, *words: str, status: int = 0) -> str:
    """Run a verb that prints, in this process; nothing may reach a terminal that is more than text."""
    with contextlib.chdir(project), judge_shipped_once(project):
        done = CliRunner().invoke(verbs, words, prog_name="archgen")
    assert done.exit_code == status, (words, done.output[-500:], done.exception)
    assert hostile.controls(done.output.replace("\r\n", "\n")) == []
    return done.stdout


def test_building_says_nothing_but_text(project: Path) -> None:
    text = (project.parent / "said.txt").read_text(encoding="utf-8")
    assert hostile.controls(text) == []
    assert not re.search(r"(?m)^\s*::", text)
    assert "simpler" not in text
    assert "wrote ../out/site/index.html\n" in text or f"wrote {project.parent}/out/site/index.html\n" in text


def test_what_is_printed_for_people(project: Path) -> None:
    for verb in ("check",), ("stats",), ("show", "a.x", "n", "p", "R-1", "UC-1", "h", "k", "v"), ("explain",):
        assert not re.search(r"(?m)^\s*::", said(project, *verb))


def test_github_s_commands_are_one_a_line_and_ours(project: Path) -> None:
    lines = said(project, "check", "--format", "github").splitlines()
    assert len(lines) > 5
    assert [line for line in lines if not re.match(r"::(error|warning|notice) file=[^:]*::", line)] == []


def test_json(project: Path) -> None:
    assert json.loads(said(project, "check", "--format", "json"))["version"] == 1
    assert json.loads(said(project, "stats", "--format", "json"))["version"] == 1


def test_documents_for_servers(project: Path) -> None:
    assert servers.sarif_schema(said(project, "check", "--format", "sarif")) == []
    assert servers.junit(said(project, "check", "--format", "junit", "--strict", status=1)) == []


def test_a_baseline_holds_the_texts(project: Path, tmp_path: Path) -> None:
    file = tmp_path / "baseline.yaml"
    said(project, "check", "--update-baseline", "--baseline", str(file))
    assert json.loads(said(project, "check", "--format", "json", "--baseline", str(file)))["diagnostics"] == []


@pytest.mark.parametrize("sort", LISTABLE_KINDS)
def test_lists(sort: str, project: Path) -> None:
    assert not re.search(r"(?m)^\s*::", said(project, "list", "--of", sort))
    assert json.loads(said(project, "list", "--of", sort, "--format", "json")) is not None
    with contextlib.chdir(project), judge_shipped_once(project):
        text = CliRunner().invoke(verbs, ["list", "--of", sort, "--format", "csv"]).stdout_bytes.decode()
    rows = list(csv.reader(io.StringIO(text, newline="")))
    assert {len(row) for row in rows} == {len(rows[0])}
    assert [cell[:40] for row in rows for cell in row if re.match(r"\s*[=+@\-\t\r]", cell)] == []


def test_the_report(kind: str, project: Path) -> None:
    report = project.parent / "out" / "report.docx"
    assert inspection.faults(report.read_bytes()) == []
    assert judges.validated(report) == []
    with zipfile.ZipFile(report) as package:
        relations = [etree.fromstring(package.read(name)) for name in package.namelist() if name.endswith(".rels")]
        document = package.read("word/document.xml").decode()
    outside = [r.get("Target", "") for part in relations for r in part if r.get("TargetMode") == "External"]
    assert {target.partition(":")[0] for target in outside} <= SCHEMES
    assert kind != "markup" or "A{{7*7}}B" in document


class Tags(HTMLParser):
    """Collects what is active in a page."""

    def __init__(self, allowed: set[str]) -> None:
        super().__init__()
        self.allowed = allowed
        self.active: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Judge a tag and its attributes."""
        shown = f"<{tag} {attrs}>"[:200]
        if tag in ACTIVE and not any(
            name == "src" and re.match(r"(\.\./)*(assets|matrix)/", value or "") for name, value in attrs
        ):
            self.active += [] if tag in self.allowed else [shown]
        self.active += [shown for name, value in attrs if name.startswith("on") or not harmless(name, value or "")]


def harmless(name: str, value: str) -> bool:
    """Say whether an attribute leads nowhere but to a file, or to an address that is one."""
    if name not in {"href", "src", "xlink:href", "action", "formaction", "srcdoc", "data"}:
        return True
    scheme = re.match(r"[\s\x00-\x20]*([a-zA-Z][a-zA-Z0-9+.\-]*):", value)
    return scheme is None or scheme[1].lower() in SCHEMES


def active(html: str, *allowed: str) -> list[str]:
    found = Tags(set(allowed))
    found.feed(html)
    found.close()
    return found.active


def test_pages_hold_nothing_active(kind: str, project: Path) -> None:
    for path, data in files(project, ".html"):
        assert active(data.decode()) == [], path
        assert "A49B" not in data.decode()
    page = (project.parent / "out" / "site" / "components" / "a.x.html").read_text("utf-8")
    assert kind != "markup" or "A{{7*7}}B" in page


def test_pictures_hold_nothing_active(project: Path) -> None:
    for path, data in files(project, ".svg"):
        root = etree.fromstring(data)
        assert root.tag == "{http://www.w3.org/2000/svg}svg"
        assert active(etree.tostring(root).decode(), "style") == [], path
    with zipfile.ZipFile(project.parent / "out" / "full.docx") as package:
        bitmaps = [package.read(name) for name in package.namelist() if name.endswith(".png")]
    assert bitmaps
    assert all(data.startswith(b"\x89PNG") for data in bitmaps)


def test_the_wiki_holds_nothing_active(project: Path) -> None:
    """As a wiki shows it: with HTML passed through, which is the worst that can be done with Markdown."""
    for path, data in files(project, ".md"):
        text = data.decode()
        assert not re.search(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]", text)
        assert active(MarkdownIt("commonmark", {"html": True}).enable("table").render(text)) == [], path


def test_the_packed_file_holds_the_texts_as_they_were(kind: str, project: Path, tmp_path: Path) -> None:
    packed = project.parent / "out" / "packed.yaml"
    shutil.copy(packed, tmp_path / "a.yaml")
    archgen_here("pack", "a.yaml", "-o", "b.yaml", cwd=tmp_path)
    assert packed.read_bytes() == (tmp_path / "b.yaml").read_bytes()
    data = yaml.safe_load(packed.read_text("utf-8"))
    assert data["project"]["description"] == hostile.TEXTS[kind]
    assert data["nodes"]["n"]["executable"] == hostile.TEXTS[kind]
    archgen_here("pack", "a.yaml", "--resolved", "-o", "c.yaml", cwd=tmp_path)
    assert yaml.safe_load((tmp_path / "c.yaml").read_text("utf-8"))["project"]["description"] == hostile.TEXTS[kind]


@pytest.mark.slow
@pytest.mark.hypothesis
@pytest.mark.parametrize("kind", ["markup"], indirect=True)
def test_no_script_runs_in_a_browser(project: Path) -> None:
    seen: list[str] = []
    by_folder: dict[str, list[str]] = {}
    for path in (path for ending in (".html", ".svg") for path, _ in files(project, ending)):
        folder = path.rpartition("/")[0]
        by_folder.setdefault(folder if folder.count("/") else path, []).append(path)
    # Pages of one folder are made alike: `make properties` opens all of them.
    pages = [path for paths in by_folder.values() for path in (paths if DRAWS_ANEW else paths[:SHOWN_PAGES])]
    with sync_playwright() as playwright:
        browser = launch_chromium(playwright)
        page = browser.new_page()
        page.on("dialog", dialogs(seen))
        page.on("request", lambda request: seen.extend([] if local(request.url) else [request.url]))
        page.on("pageerror", lambda error: seen.append(str(error)))
        for path in pages:
            page.goto(f"file://{project.parent}/out/{path}")
            schemes = "[...document.links, ...document.querySelectorAll('a')].map(a => a.protocol).filter(p => p)"
            assert set(page.evaluate(schemes)) <= {"file:", *(f"{scheme}:" for scheme in SCHEMES)}, path
        browser.close()
    assert seen == []


def dialogs(seen: list[str]) -> Callable[[Dialog], None]:
    """Note what a script says, and let the page go on."""

    def note(dialog: Dialog) -> None:
        seen.append(dialog.message)
        dialog.dismiss()

    return note


def local(url: str) -> bool:
    return url.startswith(("file://", "data:image/"))


EVERYWHERE = hostile.TEXTS["markup"].replace("\n", " ")


@pytest.mark.parametrize("kind", try_some(WORDS), indirect=True)
def test_ids_references_and_names_are_refused_in_words(kind: str, tmp_path: Path) -> None:
    """The same texts as keys and in keys with a grammar: findings, and outputs of what is left."""
    text = hostile.TEXTS[kind]
    data = hostile.project(text)
    data["groups"][text] = {"components": {text: {"inputs": {text: text}}}}
    data["groups"]["b"]["components"]["y"]["inputs"]["in"] = {"from": [text, "a.x.out"], text: text}
    data["nodes"]["n"] |= {"name": text, "namespace": text, "kind": text, "tags": [text], "host": text}
    data["nodes"]["n"]["publishes"] = {"out": {"topic": text, "message": text, "qos": text}}
    data["views"] |= {"v": {"show": text}, text: text}
    data["rules"] = {text: text}
    data[text] = text
    (tmp_path / "archgen.yaml").write_text(hostile.written(data), encoding="utf-8")
    for form in ("text", "github", "json", "sarif", "junit"):
        assert (form == "github") == bool(re.search(r"(?m)^::", said(tmp_path, "check", "--format", form, status=1)))
    done = archgen_here("build", "--keep-going", "--backend", "wiki", cwd=tmp_path, status=1)
    assert hostile.controls((done.stdout + done.stderr).decode()) == []
    for path, page in contents(tmp_path / "archgen-out").items():
        if path.endswith(".html"):
            assert active(page.decode()) == [], path
    assert inspection.faults((tmp_path / "archgen-out" / "report.docx").read_bytes()) == []


@pytest.mark.parametrize(("verb", "status"), [("show", 2), ("list", 2), ("explain", 2), ("check", 2), ("", 2)])
def test_hostile_words_on_the_command_line(verb: str, status: int, tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text("archgen: 1\n")
    text = f"{EVERYWHERE}\x1b[2J\n::error::x"
    done = archgen_here(*filter(None, (verb, text)), cwd=tmp_path, status=status)
    assert hostile.controls(done.stderr.decode()) == []
    assert done.stdout == b""
