"""Merge three versions of a slice, given as texts: what git merges line by line, settled where only its lines conflict.

Texts are proposed, the likeliest first, and proved: a proposal counts only if it says what both sides say together
(`tree_merge`), and holds the comments of both. So a wrong proposal costs time and nothing else.
"""

from __future__ import annotations

import itertools
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import lru_cache

from archgen.frozen import dataclass
from archgen.git import GitError
from archgen.git.object_reader import merge_lines
from archgen.merge.change_transfer import (
    TreeReader,
    convert_lines,
    find_line_end,
    read_normal_tree,
    read_tree,
    rename_keys,
    transfer_changes,
)
from archgen.merge.tree_merge import (
    ConflictingRun,
    KeyRename,
    MergeConflictError,
    MergedRun,
    find_renames,
    merge_sequences,
    merge_values,
    read_merged_value,
)
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingNode

_WORD = re.compile(r"[^\S\n]+|\n|[\w./-]+|.", re.DOTALL)
_MARKER_SIZE = 61
"""The length of the markers that are asked of git here: no line of a slice looks like one by accident."""
_CONFLICT = re.compile(
    rf"<{{{_MARKER_SIZE}}} ours\r?\n(?P<ours>.*?)\|{{{_MARKER_SIZE}}} base\r?\n(?P<base>.*?)={{{_MARKER_SIZE}}}\r?\n"
    rf"(?P<theirs>.*?)>{{{_MARKER_SIZE}}} theirs\r?\n",
    re.DOTALL,
)
_REMEMBERED_TEXTS = 32
"""Texts whose comments are remembered: open branches are merged in pairs, so that each text comes up again and again."""
_MAX_PROPOSALS = 64
"""Proposals for the text as a whole: each place in conflict has up to six, and they multiply."""
_MAX_COMPARED = 5_000
"""Characters of a conflict that is compared word by word: that takes time that grows with the square at worst."""


@dataclass(frozen=True, slots=True)
class SliceVersions:
    """The three versions of a slice's text: the common one, the one that is merged into, the one that is merged."""

    base: str
    ours: str
    theirs: str


@dataclass(frozen=True, slots=True)
class UnmergedSlice:
    """Why no text was found.

    `conflict_path` are the keys that lead to what both sides changed; none where a text cannot be read, or
    where nothing is contradictory (`is_settled`) and only the text is in the way. `rename_conflict` says how ids contradict,
    which lines need not do.
    """

    conflict_path: tuple[str, ...] = ()
    is_settled: bool = False
    rename_conflict: str = ""


def merge_slices(versions: SliceVersions) -> str | UnmergedSlice:
    """Return the merged text, or why there is none."""
    versions = _align_line_ends(versions)
    merged_slice = _merge_texts(versions, read_tree)
    if isinstance(merged_slice, str) or not merged_slice.conflict_path:
        return merged_slice
    # What one side writes in its short form and the other side adds keys to contradicts only in writing. The normal form
    # comes second: it has no empty entries, which people leave as blanks to fill in.
    merged_in_full = _merge_texts(versions, read_normal_tree)
    is_merged = isinstance(merged_in_full, str) or merged_in_full.is_settled
    return merged_in_full if is_merged else merged_slice


def _align_line_ends(versions: SliceVersions) -> SliceVersions:
    """Give all versions the line ends of the side that changed them: otherwise every line of it is another one."""
    base_end, our_end, their_end = map(find_line_end, (versions.base, versions.ours, versions.theirs))
    if base_end == our_end == their_end or not versions.base:
        return versions
    line_end = their_end if our_end == base_end else our_end
    return SliceVersions(*(convert_lines(text, line_end) for text in (versions.base, versions.ours, versions.theirs)))


def _merge_texts(versions: SliceVersions, read: TreeReader) -> str | UnmergedSlice:
    texts = (versions.base, versions.ours, versions.theirs)
    base, ours, theirs = (read(text) for text in texts)
    if base is None or ours is None or theirs is None:
        return UnmergedSlice()
    values = read_merged_value(base), read_merged_value(ours), read_merged_value(theirs)
    try:
        renames = list(find_renames(*values))
        followed = _follow_renames(versions, (base, ours, theirs), renames)
        if followed is not None:
            return _merge_texts(followed, read)
        expected_value = merge_values(*values)
    except MergeConflictError as conflict:
        return UnmergedSlice(() if conflict.reason else conflict.path, rename_conflict=conflict.reason)
    comments = _CommentBalance(*map(_count_comments, texts))
    for proposal in _propose_texts(versions, read):
        if comments.accepts(proposal):
            tree = read(proposal)
            if tree is not None and read_merged_value(tree) == expected_value:
                return proposal
    return UnmergedSlice(is_settled=True)


def _follow_renames(
    versions: SliceVersions, roots: tuple[MappingNode, MappingNode, MappingNode], renames: Sequence[KeyRename]
) -> SliceVersions | None:
    """Return the versions with the new ids in all of them, so that what stands below is merged; None where none is new."""
    sides = list(zip((None, True, False), (versions.base, versions.ours, versions.theirs), roots, strict=True))
    texts = [
        rename_keys(text, root, [each for each in renames if each.is_ours is not is_ours])
        for is_ours, text, root in sides
    ]
    return SliceVersions(*texts) if texts != [text for _, text, _ in sides] else None


@lru_cache(maxsize=_REMEMBERED_TEXTS)
def _count_comments(text: str) -> Counter[str]:
    return Counter(yaml_parser.list_comments(text))


@dataclass(frozen=True, slots=True)
class _CommentBalance:
    """The comments of the three versions, counted; the merged text has those that neither side took away."""

    base: Counter[str]
    ours: Counter[str]
    theirs: Counter[str]

    def accepts(self, text: str) -> bool:
        """Whether a text holds each comment as often as the changes of both sides leave it."""
        counts = _count_comments(text)
        return all(
            self._least(comment) <= counts[comment] <= self._most(comment)
            for comment in self.base | self.ours | self.theirs | counts
        )

    def _most(self, comment: str) -> int:
        return max(0, self.ours[comment] + self.theirs[comment] - self.base[comment])

    def _least(self, comment: str) -> int:
        """Return `_most` less what both sides added alike: that may be there once."""
        common = min(self.ours[comment] - self.base[comment], self.theirs[comment] - self.base[comment])
        return self._most(comment) - max(0, common)


def _propose_texts(versions: SliceVersions, read: TreeReader) -> Iterator[str]:
    yield from _merge_lines(versions)
    # Where one side reformatted the text, lines have nothing in common: the other side's changes are carried over into
    # the text that changed more.
    sides = sorted((versions.ours, versions.theirs), key=lambda text: -_count_changed_lines(versions.base, text))
    yield from transfer_changes(versions.base, sides[1], sides[0], read)
    yield from transfer_changes(versions.base, sides[0], sides[1], read)


def _count_changed_lines(base: str, changed: str) -> int:
    old_lines, new_lines = Counter(base.splitlines()), Counter(changed.splitlines())
    return (old_lines - new_lines).total() + (new_lines - old_lines).total()


def _merge_lines(versions: SliceVersions) -> Iterator[str]:
    """Propose texts merged line by line by git, with several ways out of each place where lines conflict."""
    try:
        line_merge = merge_lines(
            *(_end_last_line(text).encode() for text in (versions.base, versions.ours, versions.theirs)),
            marker_size=_MARKER_SIZE,
            shows_base=True,
        )
    except GitError:
        return
    ways_out = [
        list(dict.fromkeys(_settle_lines(run))) if isinstance(run, ConflictingRun) else [run]
        for run in _split_conflicts(line_merge.content.decode())
    ]
    for parts in itertools.islice(itertools.product(*ways_out), _MAX_PROPOSALS):
        yield "".join(parts)


def _end_last_line(text: str) -> str:
    """End the last line, so that lines can be put in any order."""
    return text if not text or text.endswith("\n") else text + find_line_end(text)


def _split_conflicts(text: str) -> Iterator[str | ConflictingRun[str]]:
    """Yield merged lines as they are, and each conflict with its three versions."""
    position = 0
    for match in _CONFLICT.finditer(text):
        yield text[position : match.start()]
        yield ConflictingRun((match["base"],), (match["ours"],), (match["theirs"],))
        position = match.end()
    yield text[position:]


def _settle_lines(run: ConflictingRun[str]) -> Iterator[str]:
    base, ours, theirs = ("".join(lines) for lines in (run.base, run.ours, run.theirs))
    # Both added something at the same place.
    if not base:
        yield ours + theirs
        yield theirs + ours
    # Both changed the same lines: word by word, as in `{rate: 10 Hz, wcet: 5 ms}`. Where both added to an empty pair of
    # braces or brackets, a comma is missing between the two.
    if max(map(len, (base, ours, theirs))) > _MAX_COMPARED:
        return
    words = list(merge_sequences(*(_WORD.findall(text) for text in (base, ours, theirs))))
    if not any(isinstance(part, ConflictingRun) and part.base for part in words):
        for separator, is_ours_first in itertools.product(("", ", "), (True, False)):
            yield "".join(_join_words(part, separator, is_ours_first=is_ours_first) for part in words)


def _join_words(run: MergedRun[str] | ConflictingRun[str], separator: str, *, is_ours_first: bool) -> str:
    if isinstance(run, MergedRun):
        return "".join(run.items)
    first, second = (run.ours, run.theirs) if is_ours_first else (run.theirs, run.ours)
    return "".join((*first, separator, *second))
