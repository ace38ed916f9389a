"""The calls of a CMakeLists.txt, with variables, lists, globs and loops filled in as far as they are plain; nothing is run."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath

from archgen.plugin import dataclass
from archgen.plugin.importing import CHARACTERS_IN_A_STEP, ForeignFileError, Span, read_bounded
from archgen.plugins.ros.ros_package.import_account import ImportAccount

_MAX_BYTES = 1_000_000
_MAX_DEPTH = 8
_FILES_COMPARED_IN_A_STEP = 2
_COMMENT = re.compile(r"#[^\n]*")
_CALL = re.compile(r"\b([A-Za-z_]\w*)\s*\(([^()]{0,20000})\)")
_WORD = re.compile(r'"([^"]*)"|([^\s"]+)')
_DEFINITIONS = frozenset({"macro", "function"})
_USE = re.compile(r"\$\{(\w+)\}")
CMAKE_FILE = "CMakeLists.txt"
_Call = tuple[str, str, Span]
"""A call as it is written: its name in lower case, what stands in its brackets, and its place."""


@dataclass(frozen=True, slots=True)
class CmakeCall:
    """A call: its name in lower case, its words, and where it stands. `folder` is that of its file."""

    name: str
    words: tuple[str, ...]
    line: int
    folder: Path

    @property
    def output_name(self) -> str:
        """What the call names the program of its target, the first of its words; empty where it does not."""
        is_naming = self.name == "set_target_properties" and "OUTPUT_NAME" in self.words[1:-1]
        return self.words[self.words.index("OUTPUT_NAME", 1) + 1] if is_naming else ""


def read_cmake_calls(
    path: Path, package: str, files: Mapping[Path, str], account: ImportAccount
) -> Iterator[CmakeCall]:
    """Yield the calls of a file, of those in folders that it adds, and of those of the package that it includes.

    `files` are those of the package, for globs, with their names in messages. The account's budget pays for each call, and
    for what is filled in.
    """
    reader = _CmakeReader(path.parent, package, files, account)
    yield from reader.read_file(path, 0)


class _CmakeReader:
    """Reads the files of one package."""

    def __init__(self, root: Path, package: str, files: Mapping[Path, str], account: ImportAccount) -> None:
        self._files, self._account = files, account
        self._variables: dict[str, list[str]] = {"PROJECT_NAME": [package], "CMAKE_SOURCE_DIR": [root.as_posix()]}
        self._variables["PROJECT_SOURCE_DIR"] = [root.as_posix()]
        self._conditions = 0
        self._macros: dict[str, tuple[list[str], list[_Call]]] = {}
        """What the files define as macros and functions: the names of their parameters, and the calls in them."""

    def read_file(self, path: Path, depth: int, folder: Path | None = None) -> Iterator[CmakeCall]:
        """Yield the calls of a file; `folder` is that of the file that includes it."""
        try:
            text = read_bounded(path, _MAX_BYTES).decode("utf-8", "replace")
        except ForeignFileError:
            return
        # Comments go, lines stay.
        plain_text = _COMMENT.sub("", text)
        calls: list[_Call] = []
        line, counted = 1, 0
        for match in _CALL.finditer(plain_text):
            line += plain_text.count("\n", counted, match.start())
            counted = match.start()
            calls.append((match[1].lower(), match[2], Span(self._files.get(path, path.name), line, 1, line, 2)))
        folder = folder or path.parent
        self._variables["CMAKE_CURRENT_SOURCE_DIR"] = [folder.as_posix()]
        self._variables["CMAKE_CURRENT_LIST_DIR"] = [path.parent.as_posix()]
        yield from self._read_calls(calls, folder, depth)

    def _read_calls(  # noqa: C901, PLR0912, PLR0915 - a command each
        self, calls: list[_Call], folder: Path, depth: int
    ) -> Iterator[CmakeCall]:
        place = 0
        while place < len(calls):
            name, text, span = calls[place]
            place += 1
            words = self._fill(text, name, span)
            if words is None:
                continue
            if name == "foreach" and depth < _MAX_DEPTH:
                end = _find_end(calls, place)
                variable, *items = words or [""]
                if items[:2] == ["IN", "LISTS"]:
                    items = [each for listed in items[2:] for each in self._variables.get(listed, ())]
                elif items[:2] == ["IN", "ITEMS"]:
                    items = items[2:]
                for item in items:
                    if not self._account.pay_to_repeat(1 + end - place, name, span):
                        break
                    self._variables[variable] = [item]
                    yield from self._read_calls(calls[place:end], folder, depth + 1)
                place = end + 1
                continue
            if name in _DEFINITIONS and words:
                end = _find_end(calls, place, name)
                self._macros[words[0].lower()] = (words[1:], calls[place:end])
                place = end + 1
                continue
            if name in self._macros and depth < _MAX_DEPTH:
                yield from self._read_macro(name, words, folder, depth, span)
                continue
            self._conditions += {"if": 1, "endif": -1}.get(name, 0)
            if name == "set" and words:
                values = [each for each in words[1:] if each not in {"CACHE", "PARENT_SCOPE"}]
                if (
                    self._conditions
                    and self._variables.setdefault(words[0], values) != values
                    and f"{{{words[0]}}}" not in text
                ):
                    # Which of two values it has is decided by what is not known here.
                    self._variables[words[0]] = [f"${{{words[0]}}}"]
                else:
                    self._variables[words[0]] = values
            elif name == "list" and words[:1] == ["APPEND"] and len(words) > 1:
                self._variables.setdefault(words[1], []).extend(words[2:])
            elif name == "file" and words[:1] in (["GLOB"], ["GLOB_RECURSE"]) and len(words) > 1:
                patterns = [each for each in words[2:] if each not in {"CONFIGURE_DEPENDS", "RELATIVE"}]
                is_paid = self._account.pay_to_repeat(
                    len(patterns) * len(self._files) // _FILES_COMPARED_IN_A_STEP, name, span
                )
                self._variables[words[1]] = (
                    self._find_files(patterns, folder, is_deep=words[0] != "GLOB") if is_paid else []
                )
            elif name == "project" and words:
                self._variables["PROJECT_NAME"] = [words[0]]
            elif name == "add_subdirectory" and words and depth < _MAX_DEPTH:
                inner = folder / words[0] / CMAKE_FILE
                if inner in self._files:
                    yield from self.read_file(inner, depth + 1)
                    self._variables["CMAKE_CURRENT_SOURCE_DIR"] = [folder.as_posix()]
            elif name == "include" and words and depth < _MAX_DEPTH and folder / words[0] in self._files:
                own_folder = self._variables["CMAKE_CURRENT_LIST_DIR"]
                yield from self.read_file(folder / words[0], depth + 1, folder)
                self._variables["CMAKE_CURRENT_LIST_DIR"] = own_folder
            else:
                yield CmakeCall(name, tuple(words), span.line, folder)

    def _read_macro(self, name: str, words: list[str], folder: Path, depth: int, span: Span) -> Iterator[CmakeCall]:
        """Yield the calls of a macro or function that is called; what it sets stays set, as in a macro."""
        parameters, body = self._macros[name]
        if not self._account.pay_to_repeat(1 + len(body), name, span):
            return
        given = {parameter: [word] for parameter, word in zip(parameters, words, strict=False)}
        given |= {f"ARGV{place}": [word] for place, word in enumerate(words)}
        given |= {"ARGV": words, "ARGN": words[len(parameters) :]}
        before = dict(self._variables)
        self._variables |= given
        yield from self._read_calls(body, folder, depth + 1)
        for parameter in given:
            self._variables.pop(parameter, None)
        self._variables |= {parameter: before[parameter] for parameter in given if parameter in before}

    def _fill(self, text: str, name: str, span: Span) -> list[str] | None:
        """Return the words of a call with the variables filled in; None for more than the budget has."""
        words: list[str] = []
        for quoted, plain in _WORD.findall(text):
            word = quoted or plain
            used = [value for use in _USE.findall(word) for value in self._variables.get(use, ())]
            steps = 1 + len(used) + sum(map(len, used)) // CHARACTERS_IN_A_STEP
            if not self._account.pay_to_repeat(steps, name, span):
                return None
            whole = _USE.fullmatch(word)
            if whole and whole[1] in self._variables:
                words += used
            else:
                filled = _USE.sub(lambda use: ";".join(self._variables.get(use[1], [use[0]])), word)
                words += [filled] if quoted or "${" in filled else filled.split(";")
        return [word for word in words if word]

    def _find_files(self, patterns: Sequence[str], folder: Path, *, is_deep: bool) -> list[str]:
        found = []
        for pattern in patterns:
            full = pattern if pattern.startswith("/") else f"{folder.as_posix()}/{pattern}"
            head, tail = str(PurePosixPath(full).parent), PurePosixPath(full).name
            for path in self._files:
                is_there = path.parent.as_posix() == head or (is_deep and path.as_posix().startswith(f"{head}/"))
                if is_there and fnmatchcase(path.name, tail):
                    found.append(path.as_posix())
        return found


def _find_end(calls: list[_Call], place: int, word: str = "foreach") -> int:
    depth = 1
    for number in range(place, len(calls)):
        depth += {word: 1, f"end{word}": -1}.get(calls[number][0], 0)
        if depth == 0:
            return number
    return len(calls)
