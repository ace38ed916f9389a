"""Print the files of tests of what differs from `main`, and of what is not committed: `make test CHANGED=1`.

A changed module has the tests that import it, those of the folder that mirrors its own, and those that tests/covered_by.yaml
names for it; a file that is no module has the tests that name it. What is only reached through others is left to `make test`.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

import yaml

from tests.module_graph import find_imports, is_test, list_modules
from tests.running import ROOT

_ALWAYS = ("tests/test_contributing.py", "tests/test_modules_are_tested.py", "tests/language/test_kinds_stand_once.py")
"""Tests of the whole tree, which take no second."""


def list_changed_files(base: str = "main") -> list[str]:
    """Return the files that differ from where this branch left another one, and those that git does not know yet."""
    left_at = _ask_git("merge-base", "HEAD", base) or ["HEAD"]
    return [*_ask_git("diff", "--name-only", left_at[0]), *_ask_git("ls-files", "--others", "--exclude-standard")]


def _ask_git(*words: str) -> list[str]:
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)  # noqa: S603, S607
    return done.stdout.splitlines() if done.returncode == 0 else []


def list_tests_of(files: Iterable[str]) -> list[str]:
    """Return the files of tests that have to do with some files of the project, in order."""
    found = {test for file in files for test in _list_tests_of_file(file)}
    return sorted(found | set(_ALWAYS)) if found else []


def _list_tests_of_file(file: str) -> Iterator[str]:
    tests = {name: path.relative_to(ROOT).as_posix() for name, path in list_modules().items() if is_test(name)}
    if file in tests.values():
        yield file
    elif file.endswith(".py"):
        module = ".".join(Path(file).with_suffix("").parts).removesuffix(".__init__")
        mirror = f"tests/{Path(file).parent.relative_to('archgen').as_posix()}/" if file.startswith("archgen/") else ""
        # Tests beside: those of the room, not of the rooms in it.
        yield from (
            path for path in tests.values() if mirror and path.startswith(mirror) and "/" not in path[len(mirror) :]
        )
        yield from (path for name, path in tests.items() if module in find_imports(name))
        covered: dict[str, list[str]] = yaml.safe_load((ROOT / "tests" / "covered_by.yaml").read_text(encoding="utf-8"))
        yield from (test for test, modules in covered.items() if module in modules)
    else:
        names = {Path(file).name, file}
        yield from (path for path in tests.values() if any(name in (ROOT / path).read_text("utf-8") for name in names))
        if file.startswith("docs/rules/"):
            yield "tests/test_rule_pages.py"
        if file.startswith(("language/", "schemas/")):
            yield from (path for path in tests.values() if path.startswith(("tests/language/", "tests/schema/")))


if __name__ == "__main__":
    sys.stdout.writelines(f"{test}\n" for test in list_tests_of(list_changed_files(*sys.argv[1:])))
