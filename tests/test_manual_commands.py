"""Each command of the manual that only reads can be typed as it stands: in the case study, or where the page says."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest

from tests import repositories
from tests.running import RAMCIP, ROOT, archgen_here

READING_VERBS = frozenset({"check", "explain", "list", "show", "start", "stats", "timing", "owners"})
PLACES = {"docs/start_up.md": ROOT / "examples/bringup"}
"""Pages that say of another project that their commands are about it."""
NEEDS_MORE = {
    "archgen check --watch": "it ends with Ctrl-C",
    "archgen timing --measured trace.txt": "a recording",
    "archgen timing --measured trace.txt --measured scan.log": "recordings",
    "archgen timing --measured trace.txt --adopt": "a recording",
    "archgen check robot; archgen build -C robot": "what the page imports before",
}
COMMANDS = [
    (page.relative_to(ROOT).as_posix(), command)
    for page in [ROOT / "README.md", *sorted(ROOT.glob("docs/*.md"))]
    for line in re.findall(r"^    (archgen [^\n]*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    if (command := re.split(r"\s{2,}|\s+#", line.strip())[0]).split()[1] in READING_VERBS
]


def test_what_needs_more_stands_in_the_manual() -> None:
    assert len(COMMANDS) > 30
    assert NEEDS_MORE.keys() <= {command for _, command in COMMANDS}


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[Path, Path]:
    """Give repositories with copies of the projects, with a release and a main line to compare with."""
    copies = {}
    for project in {RAMCIP, *PLACES.values()}:
        copies[project] = tmp_path_factory.mktemp("manual") / project.name
        shutil.copytree(project, copies[project], ignore=shutil.ignore_patterns("archgen-out"))
        repositories.repository(copies[project], {})
        repositories.git(copies[project], "tag", "v1.2")
        repositories.git(copies[project], "update-ref", "refs/remotes/origin/main", "HEAD")
    return copies


@pytest.mark.slow
@pytest.mark.parametrize(("page", "command"), [each for each in COMMANDS if each[1] not in NEEDS_MORE])
def test_a_command_can_be_typed(page: str, command: str, folders: dict[Path, Path]) -> None:
    words = shlex.split(command.partition(" | ")[0].partition(" > ")[0])[1:]
    # Nothing is wrong with the projects: another status means that the command is.
    archgen_here(*words, cwd=folders[PLACES.get(page, RAMCIP)])


@pytest.mark.slow
def test_the_first_ten_minutes_can_be_typed(tmp_path: Path) -> None:
    """What README.md begins with, with the answers that Enter gives."""
    minutes = (ROOT / "README.md").read_text(encoding="utf-8").partition("## The first ten minutes")[2]
    block = minutes.split("\n\n")[1]
    commands = [shlex.split(line, comments=True) for line in block.splitlines()]
    assert [words[:2] for words in commands[:2]] == [["archgen", "init"], ["cd", "my_robot"]]
    archgen_here(*commands[0][1:], "--yes", cwd=tmp_path)
    said = [archgen_here(*words[1:], cwd=tmp_path / "my_robot").stdout.decode() for words in commands[2:]]
    assert "no findings" in said[0]
    assert "driving.planner" in said[2]
    assert (tmp_path / "my_robot/archgen-out/report.docx").is_file()
