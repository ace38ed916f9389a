"""Measure how each verb grows: processor time, memory and bytes at once, twice and four times a size, and the slope.

Usage: python benchmarks/slopes.py [--of DIMENSION ...] [--verbs VERB ...] [--base N] [--steps N] [--limit SECONDS].
A dimension is what grows: `components`, or one of variants, partners, chains, requirements and instances beside 200
components. The slope is the exponent e of seconds = a + b * size ** e through the last three sizes, so that what a run
takes at any size (imports) does not count: 1 is linear, 2 quadratic. A slope of few tenths of a second is noise.
"""

from __future__ import annotations

import argparse
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from generate import Amounts, generate

DIMENSIONS = ("components", "variants", "partners", "chains", "requirements", "instances")
_COMPONENTS_BESIDE = 200
# archgen judges 150 variants and refuses more, which no output is made of.
_BASES = {"components": 1000, "variants": 35}
_VERBS: dict[str, tuple[str, ...]] = {
    "check": ("check", "{project}"),
    "pack": ("pack", "{project}", "-o", "{out}/packed.yaml"),
    "stats": ("stats", "{project}"),
    "list": ("list", "-C", "{project}", "--of", "connections"),
    "list variants": ("list", "-C", "{project}", "--of", "variants"),
    "show": ("show", "-C", "{project}", "g0.c0"),
    "timing": ("timing", "{project}"),
    "owners": ("owners", "{project}"),
    "interfaces": ("interfaces", "-C", "{project}", "--between", "p0", "p1", "-o", "{out}/p0-p1.md"),
    "schema": ("schema", "{project}", "-o", "{out}/schema.json"),
    "start": ("start", "{project}"),
    "simulate": ("simulate", "{project}", "--seconds", "1", "--seeds", "2"),
    "diff, one title": ("diff", "{project}", "{changed}"),
    "review": ("review", "{project}", "--no-build", "-o", "{out}/review"),
    "transform flatten": ("transform", "flatten", "-C", "{project}", "-o", "{out}/flat.yaml"),
    "new": ("new", "component", "g0.added", "-C", "{project}"),
    "fmt": ("fmt", "--diff", "{project}"),
    "rename": ("rename", "g0.c0", "fresh", "--dry-run", "-C", "{project}"),
    "move": ("move", "g0.c0", "--file", "moved.yaml", "--dry-run", "-C", "{project}"),
    "split": ("split", "groups/g0.yaml", "--by", "component", "--dry-run", "-C", "{project}"),
    "todo": ("todo", "{project}", "--partner", "p0"),
    "impact": ("impact", "{project}", "--partner", "p0"),
    "conform": ("conform", "{project}", "--against", "{graph}"),
    "diagram": ("diagram", "{project}", "-o", "{out}/diagrams"),
    "site": ("site", "{project}", "-o", "{out}/site"),
    "report": ("report", "{project}", "-o", "{out}/report.docx"),
    "export csv": ("build", "{project}", "--only", "csv", "-o", "{out}/all"),
    "export wiki": ("build", "{project}", "--only", "wiki", "-o", "{out}/all"),
    **{
        f"export {name}": ("export", name, "-C", "{project}", "-o", f"{{out}}/{name}")
        for name in ("mermaid", "reqif", "xmi")
    },
    **{
        f"generate {name}": ("generate", name, "-C", "{project}", "-o", f"{{out}}/{name}")
        for name in ("aadl", "nodl", "ros2_python", "ros2_launch", "start")
    },
}
_GRAPH = "$ ros2 node list\n/stranger\n"
"""A robot on which nothing runs that the project names: `archgen conform` tells of each node that is not there."""
_ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


@dataclass(frozen=True)
class Figures:
    """What one run took: processor seconds with all processes that it starts, its largest process, what it printed and wrote."""

    seconds: float
    megabytes: float
    output_megabytes: float
    failure: str = ""


def main() -> None:
    """Measure what the command line asks for, and print one table for each dimension."""
    parser = argparse.ArgumentParser(description="Measure how each verb grows.")
    parser.add_argument("--of", nargs="*", choices=DIMENSIONS, default=list(DIMENSIONS))
    parser.add_argument("--verbs", nargs="*", choices=list(_VERBS), default=list(_VERBS))
    parser.add_argument("--base", type=int, help="the smallest size (1000 components, 35 variants, 50 of all else)")
    parser.add_argument("--steps", type=int, default=3, help="how many sizes, each twice the one before")
    parser.add_argument("--limit", type=float, default=600, help="seconds after which a run is stopped")
    given = parser.parse_args()
    for dimension in given.of:
        base = given.base or _BASES.get(dimension, 50)
        sizes = [base * 2**step for step in range(given.steps)]
        print(f"\n{dimension}: {', '.join(map(str, sizes))}")
        print(f"{'verb':22} {'seconds':>28} {'slope':>6}   {'MB of memory':>22}   {'MB of output':>22}")
        with tempfile.TemporaryDirectory() as place:
            projects = [_make_project(dimension, size, Path(place)) for size in sizes]
            for verb in given.verbs:
                _print_row(verb, list(_measure_sizes(verb, projects, given.limit)))


def _make_project(dimension: str, size: int, place: Path) -> Path:
    """Make a project of a size, and beside it the same with one title changed."""
    folder = place / str(size) / "project"
    if dimension == "components":
        generate(size, folder)
    else:
        generate(_COMPONENTS_BESIDE, folder, Amounts(**{dimension: size}))
    changed = folder.parent / "changed"
    shutil.copytree(folder, changed)
    file = changed / "groups" / "g0.yaml"
    file.write_text(
        file.read_text(encoding="utf-8").replace("title: Component 0.0", "title: Other", 1), encoding="utf-8"
    )
    (folder.parent / "graph.txt").write_text(_GRAPH, encoding="utf-8")
    return folder


def _measure_sizes(verb: str, projects: list[Path], limit: float) -> Iterator[Figures]:
    for project in projects:
        with tempfile.TemporaryDirectory() as out:
            places = {
                "project": str(project),
                "changed": str(project.parent / "changed"),
                "graph": str(project.parent / "graph.txt"),
                "out": out,
            }
            figures = measure_command([word.format(**places) for word in _VERBS[verb]], Path(out), limit)
        yield figures
        if figures.failure:
            return


def measure_command(words: list[str], out: Path, limit: float) -> Figures:
    """Run a verb once, and give what it took. Pictures are drawn anew."""
    with tempfile.TemporaryDirectory() as cache, tempfile.TemporaryFile() as printed:
        process = subprocess.Popen(
            [sys.executable, "-m", "archgen", *words],
            stdout=printed,
            stderr=subprocess.STDOUT,
            env={**_ENVIRONMENT, "XDG_CACHE_HOME": cache},
            cwd=out,
            start_new_session=True,
        )
        end = time.monotonic() + limit
        while not (waited := os.wait4(process.pid, os.WNOHANG))[0]:
            if time.monotonic() > end:
                os.killpg(process.pid, signal.SIGKILL)
                os.wait4(process.pid, 0)
                return Figures(limit, 0, 0, f"stopped after {limit:.0f} s")
            time.sleep(0.02)
        _, status, usage = waited
        process.returncode = os.waitstatus_to_exitcode(status)
        size = printed.seek(0, os.SEEK_END) + sum(file.stat().st_size for file in out.rglob("*") if file.is_file())
        printed.seek(0)
        failure = "" if process.returncode in (0, 1) else printed.read().decode(errors="replace").strip()[-100:]
    return Figures(usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, size / 1e6, failure)


def find_slope(figures: list[Figures]) -> float:
    """Return the exponent through the last three of figures at sizes that double, whatever constant they share.

    There is none where a run was stopped: how long it would take is not known.
    """
    if len(figures) < 3 or figures[-1].failure:  # noqa: PLR2004 - a constant, a factor and an exponent
        return math.nan
    first, second, third = (each.seconds for each in figures[-3:])
    return math.log2((third - second) / (second - first)) if third > second > first else 0.0


def _print_row(verb: str, figures: list[Figures]) -> None:
    columns = [
        " ".join(f"{getattr(each, name):{width}.{digits}f}" for each in figures)
        for name, width, digits in (("seconds", 8, 2), ("megabytes", 6, 0), ("output_megabytes", 7, 2))
    ]
    slope = find_slope(figures)
    print(
        f"{verb:22} {columns[0]:>28} {slope:6.2f}   {columns[1]:>22}   {columns[2]:>22}   {figures[-1].failure}",
        flush=True,
    )


if __name__ == "__main__":
    main()
