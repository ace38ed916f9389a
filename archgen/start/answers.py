"""What the user decides when starting a project, by flags or by answers to questions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal

from archgen.emit.codeowners import HANDLE
from archgen.model import ids
from archgen.model.names import made_title

Forge = Literal["github", "gitlab", "none"]


@dataclass(frozen=True, slots=True)
class Partner:
    """An organisation; `reviewers` is who reviews its changes, as CODEOWNERS names them."""

    id: str
    title: str
    reviewers: str = ""

    @property
    def body(self) -> dict[str, str]:
        """What is written below the partner's id."""
        return {"title": self.title} | ({"reviewers": self.reviewers} if self.reviewers else {})


@dataclass(frozen=True, slots=True)
class Group:
    """One of the first groups; `owner` is the id of a partner, or empty."""

    id: str
    title: str
    owner: str = ""


@dataclass(frozen=True, slots=True)
class Answers:
    """All answers."""

    id: str
    title: str
    distro: str
    partners: tuple[Partner, ...]
    groups: tuple[Group, ...]
    forge: Forge


ROBOT = ("sensing", "driving")
"""The groups of the example that is written where the user names none."""


def partner(words: str) -> Partner:
    """Read `certh=CERTH-ITI @certh/robotics`; id, title or handle may be left out. Raise ValueError."""
    parts = words.split()
    # A handle alone does not name a partner.
    handle = parts.pop() if len(parts) > 1 and "@" in parts[-1] else ""
    if handle and not HANDLE.match(handle):
        msg = f"'{handle}' is no handle: write @user, @organisation/team or an e-mail address"
        raise ValueError(msg)
    name, title = _named(" ".join(parts), "partner")
    return Partner(name, title or made_title(name), handle)


def group(words: str, partners: Iterable[Partner]) -> Group:
    """Read `perception=certh`: a group's id or title, and the partner who owns it, if any. Raise ValueError."""
    left, _, owner = (part.strip() for part in words.partition("="))
    known = [partner.id for partner in partners]
    if owner and owner not in known:
        listed = ", ".join(known) if known else "none is named with --partner"
        msg = f"'{owner}' is no partner's id ({listed})"
        raise ValueError(msg)
    name, title = _named(left, "group")
    return Group(name, title or made_title(name), owner)


def _named(words: str, sort: str) -> tuple[str, str]:
    """Return id and title of `id=Title`, of an id, or of a title. Raise ValueError."""
    left, equals, title = (part.strip() for part in words.partition("="))
    if not left:
        msg = f"a {sort} has a name"
        raise ValueError(msg)
    if equals and not ids.is_id(left):
        msg = f"'{left}' is no id: lower-case words joined by '_'; write '{ids.made(left, sort)}={title}'"
        raise ValueError(msg)
    if ids.is_id(left):
        return left, title
    return ids.made(left.casefold() if sort == "partner" else left, sort), left


def with_partners(given: Answers, named: Mapping[str, str]) -> Answers:
    """Add the partners that a table names (title by id) to those given with title and handle."""
    known = {one.id for one in given.partners}
    more = tuple(Partner(name, title) for name, title in named.items() if name not in known)
    return replace(given, partners=(*given.partners, *more))


def distinct(found: Iterable[Partner | Group], sort: str) -> None:
    """Check that no id is used twice. Raise ValueError."""
    seen = set[str]()
    for one in found:
        if one.id in seen:
            msg = f"two {sort}s have the id '{one.id}'"
            raise ValueError(msg)
        seen.add(one.id)


def gathered(  # noqa: PLR0913 - one for each flag
    folder: str,
    *,
    title: str | None = None,
    partners: Iterable[str] = (),
    groups: Iterable[str] = (),
    distro: str | None = None,
    forge: Forge = "github",
) -> Answers:
    """Collect answers from flags and the folder's name, with defaults for the rest. Raise ValueError."""
    name = ids.made(folder, "robot")
    who = tuple(partner(words) for words in partners)
    what = tuple(group(words, who) for words in groups)
    distinct(who, "partner")
    distinct(what, "group")
    # Example groups show two owners where there are two partners.
    owners = (who[0].id, who[-1].id) if who else ("", "")
    first = tuple(Group(id_, made_title(id_), owner) for id_, owner in zip(ROBOT, owners, strict=True))
    told = (title or "").strip() or name.replace("_", " ").capitalize()
    return Answers(name, told, distro or DISTRO, who, what or first, forge)


DISTRO = "jazzy"
