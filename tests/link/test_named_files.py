"""Files of the project that elements name: documents in `urls`, pictures in `image`."""

from __future__ import annotations

from pathlib import Path

from archgen.link.named_files import is_file_path
from archgen.pipeline import CheckedProject, check_project

PNG = b"\x89PNG\r\n\x1a\n"


def check(folder: Path, text: str, name: str = "archgen.yaml") -> tuple[CheckedProject, list[str]]:
    (folder / name).write_text(f"archgen: 1\n{text}", encoding="utf-8")
    checked = check_project(folder / name if name != "archgen.yaml" else folder)
    found = [each for each in checked.findings if each.rule == "missing-file"]
    return checked, [
        f"{each.span.line}:{each.span.column} {each.element}: {each.message} | {each.help}" for each in found
    ]


def test_documents_of_every_element_are_looked_for(tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "motor.dbc").write_text("", encoding="utf-8")
    _, found = check(
        tmp_path,
        """
groups:
  g:
    urls: {a: docs/motor.dbc, b: "https://example.org/x", c: docs/moter.dbc, d: ../secret}
    components:
      c:
        inputs: {i: {external: x, urls: {a: docs/./motor.dbc, b: docs}}}
        outputs: {o: {external: x, urls: {a: a/../../secret}}}
        components: {inner: {title: I, urls: {a: gone.pdf}, node: {urls: {a: gone.md}}}}
component_types: {t: {urls: {a: gone.html}}}
nodes: {n: {urls: {a: gone.txt}}}
requirements: {R-1: {urls: {a: "mailto:x@y.eu", b: gone.pdf}}}
""",
    )
    outside = "lies outside the project's folder | copy it into the project, or write its address on the web"
    absent = "is not there | write its path from the project's folder; an address on the web begins with `https://`"
    assert found == [
        "5:62 g: the file `docs/moter.dbc` is not there | did you mean `docs/motor.dbc`?",
        f"5:81 g: the file `../secret` {outside}",
        f"9:46 g.c: the file `a/../../secret` {outside}",
        f"10:50 g.c.inner: the file `gone.pdf` {absent}",
        f"10:78 g.c.inner: the file `gone.md` {absent}",
        f"11:33 t: the file `gone.html` {absent}",
        f"12:23 n: the file `gone.txt` {absent}",
        f"13:52 R-1: the file `gone.pdf` {absent}",
    ]


def test_a_project_of_one_file_names_documents_that_lie_elsewhere(tmp_path: Path) -> None:
    assert check(tmp_path, "groups: {g: {urls: {a: gone.pdf}}}", "robot.yaml")[1] == []


def test_pictures_are_files_that_can_be_shown(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(PNG)
    (tmp_path / "huge.png").write_bytes(PNG + bytes(17 * 1024 * 1024))
    (tmp_path / "evil.svg").write_text('<!DOCTYPE x [<!ENTITY a "b">]><svg>&a;</svg>', encoding="utf-8")
    (tmp_path / "page.html").write_text("<script>alert(1)</script>", encoding="utf-8")
    (tmp_path.parent / "secret.png").write_bytes(PNG)
    checked, found = check(
        tmp_path,
        """
component_types: {t: {title: T, image: a.png}}
groups:
  g:
    components:
      a: {is: t}
      b: {title: B, image: huge.png}
      c: {title: C, image: evil.svg}
      d: {title: D, image: page.html}
      e: {title: E, image: ../secret.png}
      f: {title: F, image: b.png}
""",
    )
    unfit = "cannot be shown | a picture has at most 16 MiB, and an SVG is sound and names no entities"
    assert found == [
        f"8:28 g.b: the picture `huge.png` {unfit}",
        f"9:28 g.c: the picture `evil.svg` {unfit}",
        "10:28 g.d: `page.html` is no picture | name a PNG, JPEG or SVG file of the project",
        "11:28 g.e: the picture `../secret.png` lies outside the project's folder | copy it into the project, or write its address on the web",
        "12:28 g.f: the picture `b.png` is not there | did you mean `a.png`?",
    ]
    assert checked.chapters.read_pictures() == {"a.png": PNG}
    assert checked.architecture.components["g.a"].image == "a.png"


def test_addresses_have_a_scheme() -> None:
    assert [is_file_path(each) for each in ("docs/a.pdf", "https://a.eu/b", "mailto:a@b.eu", "a/b:c")] == [
        True,
        False,
        False,
        True,
    ]
