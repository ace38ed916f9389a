"""Change one condition, operator or number at a time, and see whether the tests of the same folder notice.

    python tools/run_mutants.py --seed 1 --count 200

Prints the mutants that survive. Those that tools/equivalent_mutants.yaml lists, with a reason, change nothing that can be
observed and do not count. Exit status 1 where five per cent or more of the others survive.
"""

from __future__ import annotations

import argparse
import ast
import itertools
import random
import shutil
import sqlite3
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import Queue

import yaml

REPOSITORY = Path(__file__).resolve().parent.parent
FOLDERS = ("compare", "link", "analyses", "timing")
SECONDS_PER_MUTANT = 60
ACCEPTED_SHARE = 0.05

_COMPARISONS = {
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.Lt: ("<", "<="),
    ast.LtE: ("<=", "<"),
    ast.Gt: (">", ">="),
    ast.GtE: (">=", ">"),
    ast.Is: ("is", "is not"),
    ast.IsNot: ("is not", "is"),
    ast.In: ("in", "not in"),
    ast.NotIn: ("not in", "in"),
}
_OPERATORS = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "+"),
    ast.FloorDiv: ("//", "*"),
    ast.Div: ("/", "*"),
}


@dataclass(frozen=True)
class Mutant:
    """One edit of one source file; offsets count characters."""

    file: str
    line: int
    start: int
    end: int
    replacement: str
    source_line: str

    def change(self, text: str) -> str:
        """Return the file's text with the edit made."""
        return text[: self.start] + self.replacement + text[self.end :]

    def describe(self, text: str) -> str:
        """Return one line: where, what was there, what is there now."""
        return (
            f"{self.file}:{self.line}: `{text[self.start : self.end]}` -> `{self.replacement}` in `{self.source_line}`"
        )


class SourceText:
    """A file's text, with the offsets (in characters) of the positions that ast gives (in bytes of a line)."""

    def __init__(self, file: str, text: str) -> None:
        self.file = file
        self.text = text
        self.lines = text.split("\n")
        self.line_starts = [0]
        for line in self.lines:
            self.line_starts.append(self.line_starts[-1] + len(line) + 1)

    def start_of(self, node: ast.expr) -> int:
        """Return the offset of an expression's first character."""
        return self._offset(node.lineno, node.col_offset)

    def end_of(self, node: ast.expr) -> int:
        """Return the offset behind an expression's last character."""
        return self._offset(node.end_lineno or 0, node.end_col_offset or 0)

    def _offset(self, line: int, byte_column: int) -> int:
        return self.line_starts[line - 1] + len(self.lines[line - 1].encode()[:byte_column].decode())

    def mutant(self, start: int, end: int, replacement: str) -> Mutant:
        """Return the mutant that puts a replacement between two offsets."""
        line = self.text.count("\n", 0, start) + 1
        return Mutant(self.file, line, start, end, replacement, self.lines[line - 1].strip())

    def exchange(self, words: tuple[str, str], left: ast.expr, right: ast.expr) -> Iterator[Mutant]:
        """Yield the mutant that exchanges the operator between two operands."""
        old, new = words
        start, end = self.end_of(left), self.start_of(right)
        place = self.text.find(old, start, end)
        # A comment between the operands may hold the same letters: only blanks and brackets may precede.
        if place >= 0 and not self.text[start:place].strip(" \n\t()"):
            yield self.mutant(place, place + len(old), new)


def find_mutants(file: str, text: str) -> Iterator[Mutant]:
    """Yield every mutant of a file. Decorators are left out: `frozen=True` and `slots=True` protect, they compute nothing."""
    source = SourceText(file, text)
    tree = ast.parse(text)
    decorating = {
        id(part)
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef)
        for d in node.decorator_list
        for part in ast.walk(d)
    }
    for node in ast.walk(tree):
        if id(node) not in decorating:
            yield from _mutate_operators(source, node)
            yield from _mutate_values(source, node)


def _mutate_operators(source: SourceText, node: ast.AST) -> Iterator[Mutant]:
    if isinstance(node, ast.BoolOp):
        words = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
        for left, right in itertools.pairwise(node.values):
            yield from source.exchange(words, left, right)
    elif isinstance(node, ast.Compare) and len(node.ops) == 1:
        yield from source.exchange(_COMPARISONS[type(node.ops[0])], node.left, node.comparators[0])
    elif isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        yield from source.exchange(_OPERATORS[type(node.op)], node.left, node.right)


def _mutate_values(source: SourceText, node: ast.AST) -> Iterator[Mutant]:
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        yield source.mutant(source.start_of(node), source.start_of(node.operand), "")
    elif isinstance(node, ast.Constant) and isinstance(node.value, int):
        changed = str(not node.value) if isinstance(node.value, bool) else str(node.value + 1)
        yield source.mutant(source.start_of(node), source.end_of(node), changed)
    elif isinstance(node, (ast.If, ast.While, ast.IfExp)) and isinstance(
        node.test, (ast.Name, ast.Attribute, ast.Call)
    ):
        start = source.start_of(node.test)
        yield source.mutant(start, start, "not ")


def record_coverage(copy: Path, folder: str) -> dict[tuple[str, int], list[str]]:
    """Run the tests of a folder and return, for each line of its code, the tests that execute it."""
    data = copy / f".coverage-{folder}"
    configuration = copy / f".coveragerc-{folder}"
    configuration.write_text(
        f"[run]\nsource = archgen/{folder}\ndata_file = {data}\ndynamic_context = test_function\n", encoding="utf-8"
    )
    command = [sys.executable, "-m", "coverage", "run", f"--rcfile={configuration}", "-m", "pytest", "-q", "-x"]
    run = subprocess.run(
        [*command, "-p", "no:cacheprovider", "-p", "no:randomly", f"tests/{folder}"],
        cwd=copy,
        capture_output=True,
        text=True,
        check=False,
    )
    if run.returncode:
        sys.exit(f"the tests of {folder} fail without a mutant:\n{run.stdout[-2000:]}")
    return _read_contexts(data, copy)


def _read_contexts(data: Path, copy: Path) -> dict[tuple[str, int], list[str]]:
    from coverage.numbits import numbits_to_nums

    tests_by_line: dict[tuple[str, int], list[str]] = defaultdict(list)
    with sqlite3.connect(data) as database:
        rows = database.execute(
            "select file.path, context.context, line_bits.numbits from line_bits "
            "join file on file.id = line_bits.file_id join context on context.id = line_bits.context_id"
        )
        for path, context, numbits in rows:
            if context:
                for line in numbits_to_nums(numbits):
                    tests_by_line[Path(path).relative_to(copy).as_posix(), line].append(context)
    return tests_by_line


def survives(mutant: Mutant, text: str, copy: Path, tests: list[str]) -> bool:
    """Run the tests that execute the mutant's line; whether all of them pass. A run that does not end counts as noticed."""
    if not tests:
        return True
    target = copy / mutant.file
    target.write_text(mutant.change(text), encoding="utf-8")
    # Contexts are `tests.compare.test_x.test_y`, without parameters: pytest takes files and -k; the files are enough to find them.
    names = sorted({context.rpartition(".")[2] for context in tests})
    files = sorted({_test_file(copy, context) for context in tests} - {""})
    try:
        run = subprocess.run(
            [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "--no-header", "--tb=no"]
            + (["-k", " or ".join(names)] if len(names) <= 40 else [])  # noqa: PLR2004 - a longer expression gains nothing
            + files,
            cwd=copy,
            capture_output=True,
            timeout=SECONDS_PER_MUTANT,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return False
    else:
        return run.returncode == 0
    finally:
        target.write_text(text, encoding="utf-8")


def _test_file(copy: Path, context: str) -> str:
    parts = context.split(".")
    for length in range(len(parts), 0, -1):
        file = Path(*parts[:length]).with_suffix(".py")
        if (copy / file).is_file():
            return file.as_posix()
    return ""


def read_equivalents() -> frozenset[tuple[str, str, str]]:
    """Return the mutants known to change nothing: file, source line, replacement."""
    entries = yaml.safe_load((REPOSITORY / "tools" / "equivalent_mutants.yaml").read_text(encoding="utf-8")) or []
    return frozenset((entry["file"], entry["line"], entry["replacement"]) for entry in entries)


def copy_repository(target: Path) -> None:
    """Copy what git tracks, so that a run never touches the working tree."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=REPOSITORY, capture_output=True, check=True).stdout
    for name in listed.decode().split("\0"):
        source = REPOSITORY / name
        if name and source.is_file():
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target / name)


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
        tests_by_line: dict[tuple[str, int], list[str]] = {}
        for folder in folders:
            tests_by_line.update(record_coverage(copies[0], folder))
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
                return survives(mutant, texts[mutant.file], copy, tests_by_line.get((mutant.file, mutant.line), []))
            finally:
                idle.put(copy)

        with ThreadPoolExecutor(options.jobs) as pool:
            survivors = [mutant for mutant, alive in zip(chosen, pool.map(judge, chosen), strict=True) if alive]
    report_survivors(chosen, survivors, texts)


def report_survivors(chosen: list[Mutant], survivors: list[Mutant], texts: dict[str, str]) -> None:
    """Print the survivors and the shares of each folder; exit with 1 where too many are alive."""
    equivalents = read_equivalents()
    alive = [m for m in survivors if (m.file, m.source_line, m.replacement.strip()) not in equivalents]
    for mutant in sorted(alive, key=lambda m: (m.file, m.line)):
        print("alive", mutant.describe(texts[mutant.file]))
    totals, living = (Counter(m.file.split("/")[1] for m in group) for group in (chosen, alive))
    for folder, total in sorted(totals.items()):
        print(f"{folder}: {living[folder]} of {total} alive")
    judged = len(chosen) - (len(survivors) - len(alive))
    print(f"{len(alive)} of {judged} alive, {len(survivors) - len(alive)} equivalent")
    sys.exit(len(alive) >= ACCEPTED_SHARE * judged)


if __name__ == "__main__":
    main()
