"""The case study's outputs, each as it was last looked at and found right: tests/golden.

`make golden` renews them; git's diff then shows what a change means for users. What differs between platforms is left
out: pictures appear by what they say, documents without page numbers and sizes. Of the site three pages stand for all.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests import readable
from tests.plugins.middlewares.middleware_projects import HEADLAMP
from tests.plugins.ros_code.test_ros2_cpp import ROBOT
from tests.running import RAMCIP, REVISION, ROOT, archgen_here, contents

GOLDEN = ROOT / "tests" / "golden"
PAGES = (
    "groups/environment_state.html",
    "components/environment_state.object_recognition.html",
    "nodes/object_recognizer.html",
)
MOST = 3_200_000
"""Bytes that all golden files may take together: they are there to be read."""

Files = dict[str, bytes]


def said(*words: str | Path) -> Callable[[Path], Files]:
    """Make the function that gives what a verb prints. It runs beside the project, which is named by its folder."""

    def printed(_: Path) -> Files:
        return {"": archgen_here(*words, cwd=ROOT).stdout}

    return printed


def written(path: str) -> Callable[[Path], Files]:
    """Make the function that gives a file of the build, or all files of a folder."""

    def read(built: Path) -> Files:
        found = contents(built / path) if (built / path).is_dir() else {"": (built / path).read_bytes()}
        return {name: data for name, data in found.items() if name != ".archgen-files"}

    return read


def resolved(built: Path) -> Files:
    archgen_here("pack", RAMCIP, "--resolved", "-o", built.parent / "resolved.yaml", cwd=built.parent)
    return {"": (built.parent / "resolved.yaml").read_bytes()}


def report(built: Path) -> Files:
    return {"": readable.document(built / "report.docx").encode()}


def diagrams(built: Path) -> Files:
    return {"": readable.pictures(built / "diagrams").encode()}


def site(built: Path) -> Files:
    pages = {name: readable.page((built / "site" / name).read_text("utf-8")) for name in PAGES}
    names = "".join(f"{name}\n" for name in contents(built / "site"))
    return {name: text.encode() for name, text in {**pages, "files.txt": names}.items()}


def neighbours(_: Path) -> Files:
    names = ("d2", "graphml", "mermaid", "plantuml", "structurizr", "xmi")
    return {name: archgen_here("export", name, "-C", "example_ramcip", cwd=ROOT).stdout for name in names}


def cpp_packages(built: Path) -> Files:
    """Generate what the case study has none of: nodes in C++, of each kind."""
    folder = built.parent / "cpp"
    folder.mkdir(exist_ok=True)
    (folder / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
    archgen_here("generate", "ros2_cpp", "-o", folder / "ws", cwd=folder)
    return {name: data for name, data in contents(folder / "ws").items() if not name.startswith(".")}


def simulations(built: Path) -> Files:
    """Generate the cleaning robot's program in both languages. One text holds a program: its files are no code of the
    tests'. Of what is the same for all projects only the names are in it.
    """
    texts: Files = {}
    for backend in ("java", "python_simulation"):
        folder = built.parent / backend
        archgen_here("generate", backend, "-o", folder, cwd=ROOT / "examples" / "cleaning_robot")
        made = {name: data for name, data in contents(folder).items() if not name.startswith(".")}
        parts = (f"==== {name}\n".encode() + (b"" if "runtime/" in name else data) for name, data in made.items())
        texts[f"{backend}.txt"] = b"".join(parts)
    return texts


def middlewares(built: Path) -> Files:
    """Generate the headlamp's components for each middleware; a text for each, as above."""
    texts: Files = {}
    folder = built.parent / "headlamp"
    folder.mkdir(exist_ok=True)
    (folder / "archgen.yaml").write_text(HEADLAMP, encoding="utf-8")
    for backend in ("openrtm", "orocos", "player"):
        archgen_here("generate", backend, "-o", folder / backend, cwd=folder)
        made = {name: data for name, data in contents(folder / backend).items() if not name.startswith(".")}
        texts[f"{backend}.txt"] = b"".join(f"==== {name}\n".encode() + data for name, data in made.items())
    return texts


OUTPUTS: dict[str, Callable[[Path], Files]] = {
    "check.txt": said("check", "example_ramcip"),
    "check.json": said("check", "example_ramcip", "--format", "json"),
    "stats.txt": said("stats", "example_ramcip"),
    "stats.json": said("stats", "example_ramcip", "--format", "json"),
    "connections.csv": said("list", "-C", "example_ramcip", "--of", "connections", "--format", "csv"),
    "packed.yaml": written("packed.yaml"),
    "resolved.yaml": resolved,
    "report.txt": report,
    "diagrams.txt": diagrams,
    "site": site,
    "wiki": written("wiki"),
    "neighbours": neighbours,
    "ros2_cpp": cpp_packages,
    "simulations": simulations,
    "middlewares": middlewares,
}


@pytest.mark.parametrize("name", OUTPUTS)
def test_nothing_changed_unseen(name: str, ramcip: Path, request: pytest.FixtureRequest) -> None:
    made = {(f"{name}/{path}" if path else name): data for path, data in OUTPUTS[name](ramcip).items()}
    if request.config.getoption("--update-golden"):
        renew(name, made)
    held = {path: (GOLDEN / path).read_bytes() for path in files(name)}
    assert sorted(held) == sorted(made), "other files than before; `make golden` takes them"
    changed = [line for path in sorted(made) for line in difference(path, held[path], made[path])]
    assert changed == [], "read what changed; if it is right, `make golden` takes it"


def files(name: str) -> Iterator[str]:
    """Name the golden files of one output."""
    place = GOLDEN / name
    found = sorted(place.rglob("*")) if place.is_dir() else [place]
    return (file.relative_to(GOLDEN).as_posix() for file in found if file.is_file())


def renew(name: str, made: Files) -> None:
    """Take what was made as right."""
    for old in set(files(name)) - set(made):
        (GOLDEN / old).unlink()
    for path, data in made.items():
        (GOLDEN / path).parent.mkdir(parents=True, exist_ok=True)
        (GOLDEN / path).write_bytes(data)


def difference(path: str, held: bytes, made: bytes) -> Iterator[str]:
    """Show the first places where two texts differ, few enough to read."""
    import difflib

    if held == made:
        return
    old, new = (data.decode("utf-8").splitlines() for data in (held, made))
    hunks = difflib.unified_diff(old, new, f"golden/{path}", path, lineterm="", n=1)
    shown = [line[:200] for line in hunks]
    yield from shown[:30] or [f"{path}: the line ends differ"]
    if len(shown) > 30:
        yield f"... and {len(shown) - 30} lines more"


def test_golden_files_can_be_read() -> None:
    sizes = {path: len(data) for path, data in contents(GOLDEN).items()}
    assert sum(sizes.values()) < MOST, sorted(sizes, key=lambda path: -sizes[path])[:3]
    known = {path.split("/")[0] for path in sizes}
    assert known == set(OUTPUTS)


def test_documents_name_the_revision_that_was_asked_for() -> None:
    assert re.search(rf"\b{REVISION}\b", (GOLDEN / "report.txt").read_text("utf-8"))
