"""A kind of element that nobody foresaw: four files and forty lines, and everything before its first page knows it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.language_samples import read_data
from tests.running import ROOT

pytestmark = pytest.mark.slow

KIND = """\
battery:
  section: batteries
  title: Battery
  says: "What feeds hosts and devices. In short form: its title."
  accepts: object string number boolean null
  example: Main battery
  snippet: {capacity: 20}
  short: title
  named_by_id: true
  effect: system
  keys:
    title: {as: title, example: Main battery}
    capacity: {type: count, says: Its capacity in ampere hours., example: 20, worse: less}
    description: {as: description, example: "Below the deck, exchangeable."}
    host: {as: host, offers: hosts}
    tags: tags
    properties: properties
    hints: hints

"""
CLASS = '''\
@dataclass(frozen=True, slots=True)
class Battery:
    """What feeds hosts and devices; `capacity` in ampere hours."""

    id: str
    title: str
    capacity: int | None = None
    host: str | None = None
    description: str | None = None
    tags: tuple[str, ...] = ()
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


'''
EDITS = (
    ("language/system.yaml", "container:\n  title: Container\n", KIND),
    ("archgen/model/deployment.py", "@dataclass(frozen=True, slots=True)\nclass Container:", CLASS),
    ("archgen/model/architecture.py", "from archgen.model.deployment import ", ""),
    (
        "archgen/model/architecture.py",
        "    containers: Mapping[str, Container]",
        "    batteries: Mapping[str, Battery] = field(default_factory=dict)\n",
    ),
    ("archgen/link/declare/element_declaration.py", "from archgen.model.deployment import ", ""),
    ("archgen/link/declare/element_declaration.py", '    "host": Host,\n', '    "battery": Battery,\n'),
)
ROBOT = """\
archgen: 1
project: {id: robot}
hosts: {pc: PC}
batteries: {main_pack: {capacity: 20, host: pc, description: Below the deck}, spare: Spare one}
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Give a function that runs Python in a copy of the package that has the new kind."""
    copy = tmp_path_factory.mktemp("copy")
    for folder in ("archgen", "language", "schemas", "tools", "docs", "backends", "passes", "ros_library"):
        shutil.copytree(ROOT / folder, copy / folder, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "ros_type_mapper.yaml", copy)
    for name, before, text in EDITS:
        content = (copy / name).read_text(encoding="utf-8")
        assert content.count(before) == 1
        # Behind the words of an import stands a name; what else is added stands before what is there.
        added = f"{text}{before}" if text else f"{before}Battery, "
        (copy / name).write_text(content.replace(before, added), encoding="utf-8")

    def run_python(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(  # noqa: S603 - our own program
            [sys.executable, *words],
            env=os.environ | {"PYTHONPATH": str(copy)},
            cwd=copy,
            capture_output=True,
            text=True,
            check=False,
        )

    made = run_python("tools/make_language.py")
    assert made.returncode == 0, made.stderr
    return run_python


def test_everything_before_its_first_page_knows_it(
    run: Callable[..., subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    assert len({name for name, _, _ in EDITS}) == 4
    assert sum(max(text.count("\n"), 1) for _, _, text in EDITS) <= 40
    for name, text in (
        ("before", ROBOT),
        ("after", ROBOT.replace("20", "10")),
        ("renamed", ROBOT.replace("main_pack", "pack")),
        ("wrong", ROBOT.replace("host: pc", "host: pd")),
    ):
        (tmp_path / name).mkdir()
        (tmp_path / name / "archgen.yaml").write_text(text, encoding="utf-8")

    def ask(*words: str, folder: str = "before") -> str:
        place = (str(tmp_path / folder),) if words[0] in {"check", "pack"} else ("-C", str(tmp_path / folder))
        answer = run("-m", "archgen", *words, *place)
        return answer.stdout + answer.stderr

    assert "no host named `pd`" in ask("check", folder="wrong")
    assert "main_pack" in ask("list", "--of", "batteries")
    assert "Below the deck" in ask("show", "main_pack")
    packed = read_data(ask("pack", "--resolved", "-o", "-"))
    assert packed["batteries"]["main_pack"]["capacity"] == 20
    for folder, sentence in (
        ("after", "battery `main_pack`: capacity 20 → 10"),
        ("renamed", "battery `main_pack` is called `pack` now"),
    ):
        assert sentence in run("-m", "archgen", "diff", str(tmp_path / "before"), str(tmp_path / folder)).stdout
