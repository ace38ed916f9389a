"""Measure speed and scale, as ratios to a parse of the same files by libyaml's events in the same run.

A ratio holds where seconds do not: machines differ, and so do their moods. Each figure is the median of several whole
processes, after one that is not counted; one that fails ends the run. Usage: python benchmarks/run.py [NAME ...], to run
only some of `example`, `check1000`, `since1000`, `check10000`, `diff1000`, `build1000`, `site`, `site1000`,
`site10000`. README.md has the figures of one machine.
"""

from __future__ import annotations

import itertools
import os
import re
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


_ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
"""As where archgen is installed: its bytecode is kept. `main` adds a picture cache of our own."""
_RUN_NUMBERS = itertools.count()


def _number_run() -> dict[str, str]:
    """Return the variables of a run that is like no earlier one: a check that is repeated would say again what that one said."""
    return {"ARCHGEN_BENCHMARK_RUN": str(next(_RUN_NUMBERS)), **_ENVIRONMENT}


def seconds(command: list[str], runs: int = 5, before: Callable[[], None] = lambda: None) -> float:
    """Give the median wall time of a command as a whole process, in seconds."""
    return statistics.median([_once(command, before) for _ in range(runs + 1)][1:])


def _once(command: list[str], before: Callable[[], None]) -> float:
    before()
    variables = _number_run()
    start = time.perf_counter()
    done = subprocess.run(command, cwd=_ROOT, env=variables, capture_output=True, check=False)
    taken = time.perf_counter() - start
    if done.returncode:
        sys.exit(f"{' '.join(command)} ended with {done.returncode}:\n{done.stderr.decode()}{done.stdout.decode()}")
    return taken


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
    _ENVIRONMENT["ARCHGEN_BENCHMARK_RUN"] = "0"
    row("check, nothing changed", seconds(archgen("check", _EXAMPLE)), base)
    del _ENVIRONMENT["ARCHGEN_BENCHMARK_RUN"]
    with tempfile.TemporaryDirectory() as place:
        out = Path(place)
        row("build, the first time", seconds(archgen("build", _EXAMPLE, "-o", out / "all"), 3, forget), base)
        row("build, nothing changed", seconds(archgen("build", _EXAMPLE, "-o", out / "all")), base)
        row("report, pictures drawn before", seconds(archgen("report", _EXAMPLE, "-o", out / "report.docx")), base)
        row("site, pictures drawn before", seconds(archgen("site", _EXAMPLE, "-o", out / "site")), base)


def forget() -> None:
    """Forget all pictures."""
    shutil.rmtree(_ENVIRONMENT["XDG_CACHE_HOME"], ignore_errors=True)


def scale(verb: str, components: int) -> None:
    """Measure a verb on a generated project."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "project"
        generate(components, folder)
        base = parse(folder)
        taken = seconds(archgen(verb, folder), 3 if verb == "check" else 1, forget)
        memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024
        row(f"{verb}, {components} components", taken, base, f"largest process so far {memory} MB")


def changes(components: int) -> None:
    """Measure a diff with fifty changes, as a ratio to a check of the same project."""
    with tempfile.TemporaryDirectory() as place:
        old, new = Path(place) / "old", Path(place) / "new"
        generate(components, old)
        shutil.copytree(old, new)
        for number, file in enumerate(sorted((new / "groups").glob("*.yaml"))[:50]):
            text = file.read_text(encoding="utf-8")
            old_words, new_words = (("wcet: ", "wcet: 1"), ("title: Component", "title: New component"))[number % 2]
            file.write_text(text.replace(old_words, new_words, 1), encoding="utf-8")
        check = seconds(archgen("check", old), 3)
        taken = seconds(archgen("diff", old, new), 3)
        print(f"{f'diff, {components} components, 50 changes':44} {taken:8.3f} s   {taken / check:8.1f} x check")


def since(components: int) -> None:
    """Measure the comparison with a revision, as a ratio to a check in the same run: it reads the project twice."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "project"
        generate(components, folder)
        person = ("-c", "user.name=bench", "-c", "user.email=bench@example.org", "-c", "commit.gpgsign=false")
        for words in (["init", "-q"], ["add", "-A"], ["commit", "-q", "-m", "as it was"]):
            subprocess.run(["git", *person, *words], cwd=folder, check=True)
        changed = max(folder.rglob("*.yaml"))
        changed.write_text(f"# changed\n{changed.read_text(encoding='utf-8')}", encoding="utf-8")
        check = seconds(archgen("check", folder))
        row(f"check, {components} components", check, check, "(of itself)")
        row(
            "check --changed-since HEAD",
            seconds(archgen("check", folder, "--changed-since", "HEAD")),
            check,
            "of a check",
        )


def site(folder: Path) -> None:
    """Measure the site: no picture drawn before, and after changes, as ratios of processor time to a check."""
    with tempfile.TemporaryDirectory() as place:
        copy, out = Path(place) / "project", Path(place) / "site"
        shutil.copytree(folder, copy)
        forget()
        check = min(_processor_seconds(archgen("check", copy)) for _ in range(3))

        def write_site(name: str) -> None:
            taken = _processor_seconds(archgen("site", copy, "-o", out))
            print(f"{name:44} {taken:8.3f} s   {taken / check:8.1f} x check   processor time")

        write_site(f"site, {folder.name}")
        file = min((copy / "groups").glob("*.yaml"))
        text = file.read_text(encoding="utf-8")
        for key, what in (("functionality", "a component's text"), ("title", "a group's title")):
            text, count = re.subn(rf"^( +{key}: (?:>-\n +)?)", r"\1New ", text, count=1, flags=re.MULTILINE)
            if not count:
                sys.exit(f"{file} has no {key} to change")
            file.write_text(text, encoding="utf-8")
            write_site(f"site, {what} changed")
        # Without the list of the files, which no page loads.
        sizes = [path.stat().st_size for path in out.rglob("*") if path.is_file() and path.name != ".archgen-files"]
        memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024
        print(
            f"{'site, bytes':44} {sum(sizes) / 1e6:8.1f} MB  largest file {max(sizes) / 1e6:.2f} MB, largest process so far {memory} MB"
        )


def _processor_seconds(command: list[str]) -> float:
    """Measure the processor time of a command and the processes that it starts."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    _once(command, lambda: None)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def generated_site(components: int) -> None:
    """Measure the site of a generated project."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / f"{components} components"
        generate(components, folder)
        site(folder)


def main() -> None:
    """Run the benchmarks that the command line names, or all of them."""
    parts: dict[str, Callable[[], None]] = {
        "example": example,
        "check1000": lambda: scale("check", 1_000),
        "since1000": lambda: since(1_000),
        "check10000": lambda: scale("check", 10_000),
        "diff1000": lambda: changes(1_000),
        "build1000": lambda: scale("build", 1_000),
        "site": lambda: site(_EXAMPLE),
        "site1000": lambda: generated_site(1_000),
        "site10000": lambda: generated_site(10_000),
    }
    with tempfile.TemporaryDirectory() as cache:
        _ENVIRONMENT["XDG_CACHE_HOME"] = str(Path(cache) / "pictures")
        for name in sys.argv[1:] or list(parts):
            parts[name]()


if __name__ == "__main__":
    main()
