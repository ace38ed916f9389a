"""Change one condition, operator or number at a time, and see whether the tests of the same folder notice.

    python tools/run_mutants.py --seed 1 --count 200

Prints the mutants that survive. Those that tools/equivalent_mutants.yaml lists, with a reason, change nothing that can be
observed and do not count. Exit status 1 where five per cent or more of the others survive.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import Queue

import yaml
from mutant_kinds import Mutant, find_mutants

REPOSITORY = Path(__file__).resolve().parent.parent
FOLDERS = ("compare", "link", "analyses", "timing")
ACCEPTED_SHARE = 0.05
_TEST_SECONDS, _RUN_SECONDS = 30, 60
"""How long the tests of one mutant may take as they were recorded, and how long their run with it: seconds of the processor,
which other work on the machine does not prolong."""
_WAITING_SECONDS = 600
"""How long a run may take by the clock, if it waits for something."""
_PYTEST_OPTIONS = ("-q", "--assert=plain", "-p", "no:cacheprovider")
_STOPPED_STATUSES = {-signal.SIGXCPU, -signal.SIGKILL}
_JUDGED_STATUSES = {0, 1, 2, 4}
"""Pytest's exit statuses: passed, failed, not collected (2 and 4: the mutant breaks an import). The rest is our mistake."""


@dataclass(frozen=True)
class SuiteRecord:
    """What one run of a folder's tests without any mutant shows."""

    tests_by_line: Mapping[tuple[str, int], frozenset[str]]
    """Tests by the lines that they execute; `""` for what runs at import, or for several tests at once."""
    seconds_by_test: Mapping[str, float]

    def tests_of(self, mutant: Mutant) -> list[str]:
        """Return the tests that may notice a mutant, the quick ones first, as many of them as there is time for."""
        first_line, last_line = mutant.lines
        tests = frozenset[str]().union(
            *(self.tests_by_line.get((mutant.file, line), ()) for line in range(first_line, last_line + 1))
        )
        # A constant or a shared fixture: any test may rest on it, but those that execute the line come first.
        chosen = self.seconds_by_test if "" in tests else tests & self.seconds_by_test.keys()
        ordered = sorted(chosen, key=lambda test: (test not in tests, self.seconds_by_test[test], test))
        # What only the slowest tests would notice survives: such a fault should have a quick test.
        total_seconds = itertools.accumulate(self.seconds_by_test[test] for test in ordered)
        return [test for test, seconds in zip(ordered, total_seconds, strict=True) if seconds <= _TEST_SECONDS]


def record_suite(copy: Path, folder: str) -> SuiteRecord:
    """Run the tests of a folder, and return what each of them executes of its code and how long it takes."""
    data, seconds = copy / f".coverage-{folder}", copy / f".seconds-{folder}"
    configuration = copy / f".coveragerc-{folder}"
    configuration.write_text(f"[run]\nsource = archgen/{folder}\ndata_file = {data}\n", encoding="utf-8")
    command = [sys.executable, "-m", "coverage", "run", f"--rcfile={configuration}", "-m", "pytest"]
    run = subprocess.run(
        [*command, *_PYTEST_OPTIONS, "-p", "record_contexts", f"tests/{folder}"],
        cwd=copy,
        env={**os.environ, "PYTHONPATH": f"{copy}{os.pathsep}{copy / 'tools'}", "TEST_SECONDS": str(seconds)},
        capture_output=True,
        text=True,
        check=False,
    )
    if run.returncode not in {0, 1}:
        sys.exit(f"the tests of {folder} do not run without a mutant:\n{run.stdout[-2000:]}")
    # Some measure time, and fail while coverage is recorded: they cannot judge.
    print(*(f"left out: {line}" for line in run.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))), sep="\n")
    return SuiteRecord(_read_contexts(data, copy), json.loads(seconds.read_text(encoding="utf-8")))


def _read_contexts(data: Path, copy: Path) -> dict[tuple[str, int], frozenset[str]]:
    from coverage.numbits import numbits_to_nums

    tests_by_line: dict[tuple[str, int], set[str]] = defaultdict(set)
    with sqlite3.connect(data) as database:
        rows = database.execute(
            "select file.path, context.context, line_bits.numbits from line_bits "
            "join file on file.id = line_bits.file_id join context on context.id = line_bits.context_id"
        )
        for path, context, numbits in rows:
            for line in numbits_to_nums(numbits):
                tests_by_line[Path(path).relative_to(copy).as_posix(), line].add(context)
    return {place: frozenset(tests) for place, tests in tests_by_line.items()}


def survives(mutant: Mutant, text: str, copy: Path, record: SuiteRecord) -> bool:
    """Run the tests that may notice a mutant; whether all of them pass. A run that does not end counts as noticed."""
    tests = record.tests_of(mutant)
    if not tests:
        return True
    target = copy / mutant.file
    written = target.stat()
    target.write_text(mutant.change(text), encoding="utf-8")
    selection = copy / ".selected-tests"
    selection.write_text("\n".join(tests), encoding="utf-8")
    pytest_command = [sys.executable, "-B", "-m", "pytest", *_PYTEST_OPTIONS, "-x", "--no-header", "--tb=no"]
    # Only the shell sets this limit wherever there is one, and without code between fork and exec.
    limit_command = ["sh", "-c", f'ulimit -t {_RUN_SECONDS}; exec "$@"', "sh"]
    try:
        run = subprocess.run(
            [*limit_command, *pytest_command, f"@{selection}"],
            cwd=copy,
            # Processes that archgen starts look for the package here, else they find the one that is installed.
            env={**os.environ, "PYTHONPATH": str(copy)},
            capture_output=True,
            timeout=_WAITING_SECONDS,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return False
    finally:
        target.write_text(text, encoding="utf-8")
        # The compiled file is valid for this time of change only: -B above keeps it from being replaced.
        os.utime(target, ns=(written.st_atime_ns, written.st_mtime_ns))
    if run.returncode in _STOPPED_STATUSES:
        return False
    if run.returncode not in _JUDGED_STATUSES:
        sys.exit(f"pytest ended with {run.returncode}:\n{run.stdout.decode()[-2000:]}")
    return run.returncode == 0


def read_equivalents() -> frozenset[tuple[str, str, str]]:
    """Return the mutants known to change nothing: file, source line, replacement."""
    entries = yaml.safe_load((REPOSITORY / "tools" / "equivalent_mutants.yaml").read_text(encoding="utf-8")) or []
    return frozenset((entry["file"], entry["line"], entry["replacement"]) for entry in entries)


def copy_repository(target: Path) -> None:
    """Copy what git tracks or would track, so that a run never touches the working tree."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=REPOSITORY, capture_output=True, check=True).stdout
    for name in listed.decode().split("\0"):
        source = REPOSITORY / name
        if name and source.is_file():
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target / name)
    # A library beside a project is read only inside of a repository: without one, the tests of such examples could not judge.
    subprocess.run(["git", "init", "--quiet"], cwd=target, check=True)
    subprocess.run([sys.executable, "-m", "compileall", "-q", "archgen", "tests"], cwd=target, check=True)


def main() -> None:
    """Run as many mutants as asked for, chosen by a seed, and print the survivors."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--folder", action="append", choices=FOLDERS, help="only this folder; may be repeated")
    options = parser.parse_args()
    folders = tuple(options.folder or FOLDERS)
    with tempfile.TemporaryDirectory(prefix="archgen-mutants-") as temporary:
        copies = [Path(temporary) / str(number) for number in range(options.jobs)]
        for copy in copies:
            copy_repository(copy)
        records = {folder: record_suite(copies[0], folder) for folder in folders}
        texts = {
            path.relative_to(copies[0]).as_posix(): path.read_text(encoding="utf-8")
            for folder in folders
            for path in sorted((copies[0] / "archgen" / folder).rglob("*.py"))
        }
        mutants = [mutant for file, text in texts.items() for mutant in find_mutants(file, text)]
        chosen = random.Random(options.seed).sample(mutants, min(options.count, len(mutants)))  # noqa: S311 - no secret
        idle: Queue[Path] = Queue()
        for copy in copies:
            idle.put(copy)

        def judge(mutant: Mutant) -> bool:
            copy = idle.get()
            try:
                return survives(mutant, texts[mutant.file], copy, records[mutant.file.split("/")[1]])
            finally:
                idle.put(copy)

        equivalents = read_equivalents()
        survivors, alive = [], []
        with ThreadPoolExecutor(options.jobs) as pool:
            for mutant, has_survived in zip(chosen, pool.map(judge, chosen), strict=True):
                if has_survived:
                    survivors.append(mutant)
                    if (mutant.file, mutant.source_line, mutant.replacement.strip()) not in equivalents:
                        alive.append(mutant)
                        print("alive", mutant.describe(texts[mutant.file]), flush=True)
    report_shares(chosen, survivors, alive)


def report_shares(chosen: list[Mutant], survivors: list[Mutant], alive: list[Mutant]) -> None:
    """Print how many survive in each folder; exit with 1 where too many are alive."""
    totals, living = (Counter(m.file.split("/")[1] for m in group) for group in (chosen, alive))
    for folder, total in sorted(totals.items()):
        print(f"{folder}: {living[folder]} of {total} alive")
    judged = len(chosen) - (len(survivors) - len(alive))
    print(f"{len(alive)} of {judged} alive, {len(survivors) - len(alive)} equivalent")
    sys.exit(len(alive) >= ACCEPTED_SHARE * judged)


if __name__ == "__main__":
    main()
