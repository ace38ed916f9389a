"""Measure speed and scale, as ratios to a parse of the same files by libyaml's events in the same run.

A ratio holds where seconds do not: machines differ, and so do their moods. Each figure is the median of several whole
processes. Usage: python benchmarks/run.py [NAME ...], to run only some.
"""

from __future__ import annotations

import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from generate import generate

_ROOT = Path(__file__).resolve().parent.parent
_EXAMPLE = _ROOT / "example_ramcip"
_PARSE = """
import sys, yaml
for name in sys.argv[1:]:
    with open(name, 'rb') as file:
        parser = yaml.CLoader(file)
        while parser.get_event() is not None:
            pass
"""


def seconds(
    command: list[str], runs: int = 5, before: Callable[[], None] = lambda: None, statuses: tuple[int, ...] = (0,)
) -> float:
    """Give the median wall time of a command as a whole process, in seconds."""
    times = []
    for _ in range(runs):
        before()
        start = time.perf_counter()
        done = subprocess.run(command, cwd=_ROOT, capture_output=True, check=False)
        times.append(time.perf_counter() - start)
        if done.returncode not in statuses:
            sys.exit(done.stderr.decode())
    return statistics.median(times)


def archgen(*words: str | Path) -> list[str]:
    """Give the command line of a verb."""
    return [sys.executable, "-m", "archgen", *map(str, words)]


def parse(folder: Path) -> float:
    """Time libyaml's events over a project's files, less the start of Python."""
    files = [str(file) for file in sorted(folder.rglob("*.yaml")) if "archgen-out" not in file.parts]
    return seconds([sys.executable, "-c", _PARSE, *files]) - seconds([sys.executable, "-c", "import yaml"])


def row(name: str, taken: float, base: float, detail: str = "") -> None:
    """Print one figure."""
    print(f"{name:44} {taken:8.3f} s   {taken / base:8.1f} x parse   {detail}")


def example() -> None:
    """Measure the case study: check, each output, everything twice."""
    base = parse(_EXAMPLE)
    print(f"\nexample_ramcip: parsing its files by libyaml's events takes {base:.3f} s")
    row("archgen --help", seconds(archgen("--help")), base)
    row("check", seconds(archgen("check", _EXAMPLE)), base)
    with tempfile.TemporaryDirectory() as place:
        out = Path(place) / "out"
        row("report", seconds(archgen("report", _EXAMPLE, "-o", out / "report.docx"), 3), base)
        row("site", seconds(archgen("site", _EXAMPLE, "-o", out / "site"), 3), base)
        both = archgen("build", _EXAMPLE, "-o", out / "all")
        fresh = {**os.environ, "XDG_CACHE_HOME": str(out / "cache")}
        os.environ.update(fresh)

        def forget() -> None:
            shutil.rmtree(out, ignore_errors=True)

        row("build, the first time", seconds(both, 3, forget), base)
        row("build, nothing changed", seconds(both, 5), base)


def scale(components: int) -> None:
    """Measure a check of a generated project."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "project"
        generate(components, folder)
        base = parse(folder)
        taken = seconds(archgen("check", folder), 3)
        memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024
        row(f"check, {components} components", taken, base, f"largest process so far {memory} MB")


def main() -> None:
    """Run the benchmarks that the command line names, or all of them."""
    parts: dict[str, Callable[[], None]] = {
        "example": example,
        "1000": lambda: scale(1_000),
        "10000": lambda: scale(10_000),
    }
    for name in sys.argv[1:] or list(parts):
        parts[name]()


if __name__ == "__main__":
    main()
