"""What the user decides when starting a project, by flags or by answers to questions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Literal

from archgen.diagnostics import replace_surrogates
from archgen.emit.codeowners_file import REVIEWER_HANDLE
from archgen.frozen import dataclass, replace
from archgen.model import element_ids
from archgen.model.path_resolver import title_from_id

ForgeName = Literal["github", "gitlab", "none"]


@dataclass(frozen=True, slots=True)
class PartnerAnswer:
    """An organisation; `reviewers` is who reviews its changes, as CODEOWNERS names them."""

    id: str
    title: str
    reviewers: str = ""

    @property
    def body(self) -> dict[str, str]:
        """What is written below the partner's id."""
        return {"title": self.title} | ({"reviewers": self.reviewers} if self.reviewers else {})


@dataclass(frozen=True, slots=True)
class GroupAnswer:
    """One of the first groups; `owner` is the id of a partner, or empty."""

    id: str
    title: str
    owner: str = ""


@dataclass(frozen=True, slots=True)
class StartAnswers:
    """All answers."""

    id: str
    title: str
    distro: str
    partners: tuple[PartnerAnswer, ...]
    groups: tuple[GroupAnswer, ...]
    forge: ForgeName
    is_empty: bool = False
    """Whether the groups have no components yet, and no requirement shows how one looks."""


EXAMPLE_GROUPS = ("sensing", "driving")
"""The groups of the example that is written where the user names none."""


def parse_partner(text: str) -> PartnerAnswer:
    """Read `certh=CERTH-ITI @certh/robotics`; id, title or handle may be left out. Raise ValueError."""
    items = text.split()
    # A handle alone does not name a partner.
    handle = items.pop() if len(items) > 1 and "@" in items[-1] else ""
    if handle and not REVIEWER_HANDLE.match(handle):
        raise ValueError(f"'{handle}' is no handle: write @user, @organisation/team or an e-mail address")
    name, title = _parse_id_and_title(" ".join(items), "partner")
    return PartnerAnswer(name, title or title_from_id(name), handle)


def parse_group(text: str, partners: Iterable[PartnerAnswer]) -> GroupAnswer:
    """Read `perception=certh`: a group's id or title, and the partner who owns it, if any. Raise ValueError."""
    group_text, _, owner = (item.strip() for item in text.partition("="))
    partner_ids = [known_partner.id for known_partner in partners]
    if owner and owner not in partner_ids and _make_id(owner, "partner") in partner_ids:
        owner = _make_id(owner, "partner")
    if owner and owner not in partner_ids:
        listed = ", ".join(partner_ids) if partner_ids else "none is named with --partner"
        raise ValueError(f"'{owner}' is no partner's id ({listed})")
    name, title = _parse_id_and_title(group_text, "group")
    return GroupAnswer(name, title or title_from_id(name), owner)


def _parse_id_and_title(text: str, kind: str) -> tuple[str, str]:
    """Return id and title of `id=Title`, of an id, or of a title. Raise ValueError."""
    first_part, has_equals, title = (item.strip() for item in text.partition("="))
    if not first_part:
        raise ValueError(f"a {kind} has a name")
    if element_ids.is_id(first_part):
        return first_part, title
    return _make_id(first_part, kind), title if has_equals else first_part


def _make_id(name: str, kind: str) -> str:
    """Return the id that a name gets: `robo corp` is the partner `robo_corp`."""
    return element_ids.make_id(name.casefold() if kind == "partner" else name, kind)


def add_partners(answers: StartAnswers, titles_by_id: Mapping[str, str]) -> StartAnswers:
    """Add the partners that a table names (title by id) to those given with title and handle."""
    known_ids = {partner_answer.id for partner_answer in answers.partners}
    new_partners = tuple(PartnerAnswer(name, title) for name, title in titles_by_id.items() if name not in known_ids)
    return replace(answers, partners=(*answers.partners, *new_partners))


def require_distinct(items: Iterable[PartnerAnswer | GroupAnswer], kind: str) -> None:
    """Check that no id is used twice. Raise ValueError."""
    seen_ids = set[str]()
    for item in items:
        if item.id in seen_ids:
            raise ValueError(f"two {kind}s have the id '{item.id}'")
        seen_ids.add(item.id)


def collect_answers(  # noqa: PLR0913 - one for each flag
    folder: str,
    *,
    title: str | None = None,
    partners: Iterable[str] = (),
    groups: Iterable[str] = (),
    distro: str | None = None,
    forge: ForgeName = "github",
    is_empty: bool = False,
) -> StartAnswers:
    """Collect answers from flags and the folder's name, with defaults for the rest. Raise ValueError."""
    # Names of files and words of the command line may be no UTF-8: what is written is.
    folder, title = replace_surrogates(folder), replace_surrogates(title or "")
    name = element_ids.make_id(folder, "robot")
    parsed_partners = tuple(parse_partner(replace_surrogates(words)) for words in partners)
    parsed_groups = tuple(parse_group(replace_surrogates(words), parsed_partners) for words in groups)
    require_distinct(parsed_partners, "partner")
    require_distinct(parsed_groups, "group")
    # Example groups show two owners where there are two partners.
    owners = (parsed_partners[0].id, parsed_partners[-1].id) if parsed_partners else ("", "")
    example_groups = tuple(
        GroupAnswer(id_, title_from_id(id_), owner) for id_, owner in zip(EXAMPLE_GROUPS, owners, strict=True)
    )
    # A name with a blank or an accent is typed as a title; `my-robot` is not.
    is_title = " " in folder.strip() or not folder.isascii()
    project_title = title.strip() or (folder.strip() if is_title else name.replace("_", " ").capitalize())
    first_groups = parsed_groups or (() if is_empty else example_groups)
    return StartAnswers(name, project_title, distro or DEFAULT_DISTRO, parsed_partners, first_groups, forge, is_empty)


DEFAULT_DISTRO = "jazzy"
