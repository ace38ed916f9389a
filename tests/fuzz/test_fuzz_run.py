"""About a minute of `make fuzz`, the same inputs each time: all readers, guided by coverage where Atheris is installed for it."""

from __future__ import annotations

import ast
import io
import json
import os
import random
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
import yaml
from lxml import etree

from tests.fuzz import run_fuzz
from tests.fuzz.fuzz_mutations import SEPARATOR, mutate_input, write_zip
from tests.fuzz.fuzz_targets import Target, list_targets
from tests.fuzz.run_fuzz import FuzzRun
from tests.running import ROOT

FUZZ_PYTHON = ROOT / ".make/fuzz-tools/bin/python"


def start_fuzz(work: Path, *words: str, python: str = sys.executable) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONHASHSEED": "0"}
    command = [python, "-m", "tests.fuzz.run_fuzz", "--work", str(work), *words]
    # Files: what is forked there would hold pipes open when it is ended.
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        settings: dict[str, Any] = {"cwd": ROOT, "env": environment, "stdout": output, "stderr": errors, "timeout": 800}
        done = subprocess.run(command, check=False, **settings)  # noqa: S603 - our own program
        output.seek(0)
        errors.seek(0)
        return subprocess.CompletedProcess(command, done.returncode, output.read(), errors.read())


def describe_faults(work: Path, done: subprocess.CompletedProcess[str]) -> str:
    """Return what a run counted where something broke, and where and at which input it did."""
    counted = [line for line in done.stdout.splitlines() if " 0 faults" not in line]
    errors = [
        f"{file.stem}, at {file.with_suffix('').read_bytes()!r}:\n{file.read_text()}"
        for file in sorted((work / "found").glob("*.txt"))
    ]
    unended = [
        f"{file.stem} came to no end:\n{file.read_text(errors='replace')[-2000:]}"
        for file in sorted((work / "counts").glob("*.log"))
        if not file.with_suffix(".json").exists()
    ]
    return "\n".join((*counted, *errors, *unended, done.stderr[-2000:]))


def test_a_process_that_waits_for_ever_is_ended() -> None:
    waiting = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
    run_fuzz.wait_for(waiting.pid, 0.05)
    assert not Path(f"/proc/{waiting.pid}").exists()
    waiting.wait(10)


@pytest.mark.slow
def test_a_minute_finds_nothing(tmp_path: Path) -> None:
    python = str(FUZZ_PYTHON) if FUZZ_PYTHON.exists() else sys.executable
    done = start_fuzz(tmp_path, "--seconds", "60", "--counted", python=python)
    assert done.returncode == 0, describe_faults(tmp_path, done)
    counts = {file.stem: json.loads(file.read_text()) for file in (tmp_path / "counts").glob("*.json")}
    assert set(counts) == {target.name for target in list_targets()}
    assert {name: count["inputs"] for name, count in counts.items()} == json.loads(run_fuzz.INPUTS_FILE.read_text())


def break_on_purpose(parts: Sequence[bytes], folder: Path) -> None:
    del folder
    if parts[0].startswith(b"loop"):
        while True:
            pass
    assert 1 / (len(parts[0]) - 3)


def test_what_breaks_is_kept_once_for_each_place_as_its_smallest_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run_fuzz, "PROCESSOR_SECONDS", 0.2)
    run = FuzzRun(Target("x", ("lines",), break_on_purpose, lambda: [b"a"]), tmp_path, 1)
    run.begin()
    for data in (b"abc" + SEPARATOR + b"more", b"fine", b"abc", b"abc" + SEPARATOR, b"looping", b"loop"):
        run.take_input(data)
    run.write_counts(1)
    kept = {path.name: path.read_bytes() for path in (tmp_path / "found").iterdir() if path.suffix != ".txt"}
    assert kept == {"x-ZeroDivisionError-oracle": b"abc", "x-TooLongError-oracle": b"loop"}
    counts = json.loads((tmp_path / "counts/x.json").read_text())
    assert (counts["inputs"], counts["faults"]) == (6, {"x-ZeroDivisionError-oracle": 3, "x-TooLongError-oracle": 2})


@pytest.mark.parametrize("kind", ["xml", "yaml", "python", "zip", "lines"])
def test_changes_are_the_same_for_a_seed_and_mostly_sound(kind: str) -> None:
    sound = {
        "xml": b"<a x='1'><b>text</b><c/></a>",
        "yaml": b"a: {b: [1, 2], c: text}",
        "python": b"x = f(1, [2, 'a'])\ny = x",
        "zip": write_zip([("a.xml", b"<a><b/></a>")]),
        "lines": b"one two\nthree",
    }[kind]
    made = [mutate_input((kind,), sound, ["word"], random.Random(seed)) for seed in range(200)]  # noqa: S311 - no secrets
    assert made == [mutate_input((kind,), sound, ["word"], random.Random(seed)) for seed in range(200)]  # noqa: S311 - no secrets
    assert len(set(made)) > 100
    assert sum(map(READS[kind], made)) > 100


def can(read: Callable[[bytes], object]) -> Callable[[bytes], bool]:
    def try_it(data: bytes) -> bool:
        try:
            read(data)
        except (ValueError, SyntaxError, yaml.YAMLError, etree.LxmlError, zipfile.BadZipFile):
            return False
        return True

    return try_it


READS = {
    "xml": can(etree.fromstring),
    "yaml": can(yaml.safe_load),
    "python": can(ast.parse),
    "zip": can(lambda data: zipfile.ZipFile(io.BytesIO(data)).namelist()),
    "lines": can(bytes.decode),
}
