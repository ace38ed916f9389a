"""Small inputs that ask for far more than they have bytes are read within some seconds and a gigabyte, and end with a sentence."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.importers.bombs import BOMBS, Bomb, write_files
from tests.property_sizes import DRAWS_ANEW, try_some
from tests.running import ROOT

PROCESSOR_SECONDS = 60
"""Ten on a quiet machine; a slower one, other tests beside it and full caches make it several times more."""
_SHARE = 4
"""`make test-all` tries one of so many that are not quick, `make properties` each."""
ADDRESSES = 1_500_000_000
RESIDENT_BYTES = 1_000_000_000


_LAUNCHER = """
import os, resource, sys
addresses, seconds = map(int, sys.argv[1:3])
process = os.fork()
if process == 0:
    resource.setrlimit(resource.RLIMIT_AS, (addresses, addresses))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
    os.execv(sys.executable, [sys.executable, *sys.argv[3:]])
_, status, usage = os.wait4(process, 0)
print(f"\\n{status} {usage.ru_maxrss}")
"""
"""A process counts what the one that it came of held, too: it is a small one, not the one that runs all tests."""


def _explode(bomb: Bomb, folder: Path) -> None:
    write_files(bomb, folder)
    words = ["-m", "archgen", *bomb.words.split()]
    done = subprocess.run(  # noqa: S603 - our own program
        [sys.executable, "-S", "-c", _LAUNCHER, str(ADDRESSES), str(PROCESSOR_SECONDS), *words],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(folder / "cache")},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )
    said, _, figures = done.stdout.decode("utf-8", "replace").rstrip("\n").rpartition("\n")
    status, resident_kib = map(int, figures.split())
    code = os.waitstatus_to_exitcode(status)
    assert code in {0, 1, 2}, f"ended by signal {-code}: {said[-1000:]}"
    assert "mistake in archgen" not in said, said[-2000:]
    assert "Traceback" not in said, said[-2000:]
    assert resident_kib * 1024 < RESIDENT_BYTES
    assert bomb.said in said


def _list_slow_bombs() -> list[Bomb]:
    return [bomb for bomb in BOMBS if not bomb.is_quick]


@pytest.mark.slow
@pytest.mark.hypothesis
@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are those of Linux")
@pytest.mark.parametrize(
    "bomb",
    [pytest.param(bomb, id=bomb.name.replace(" ", "_")) for bomb in _list_slow_bombs()[:: 1 if DRAWS_ANEW else _SHARE]],
)
def test_a_bomb_ends_with_a_sentence(bomb: Bomb, tmp_path: Path) -> None:
    _explode(bomb, tmp_path)


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are those of Linux")
@pytest.mark.parametrize(
    "bomb", try_some([pytest.param(bomb, id=bomb.name.replace(" ", "_")) for bomb in BOMBS if bomb.is_quick], 3)
)
def test_a_quick_bomb_ends_with_a_sentence(bomb: Bomb, tmp_path: Path) -> None:
    _explode(bomb, tmp_path)


def test_the_names_of_bombs_are_different() -> None:
    assert len({bomb.name for bomb in BOMBS}) == len(BOMBS) > 40
