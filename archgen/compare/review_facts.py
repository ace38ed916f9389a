"""What two versions do not say themselves: who made the change, who wrote each agreement, and what had changed by then."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping

from archgen.frozen import dataclass, field
from archgen.model.architecture import Partner

Author = frozenset[str]
"""One person by all names that are known: `@login`, an e-mail address; in lower case."""
_FORGE_MAIL = re.compile(r"(?:\d+[+-])?([a-z\d][a-z\d_.-]*)@users\.noreply\.git(?:hub|lab)\.com")


def name_author(login: str = "", mail: str = "") -> Author:
    """Return a person by login and e-mail address; an address that a forge made up holds the login."""
    found = _FORGE_MAIL.fullmatch(mail.lower())
    login = login or (found[1] if found else "")
    return frozenset(filter(None, (f"@{login.lower()}" if login else "", mail.lower())))


@dataclass(frozen=True, slots=True)
class ReviewFacts:
    """What is known of a change beside its two versions; nothing at all where these are folders or files.

    `requesters` are the people for whom the forge runs its job: who opened the request, then who moved it. `authors` wrote
    its commits, as git tells: anybody can write anything there, so that they count where no forge says who it was.
    """

    requesters: tuple[Author, ...] = ()
    authors: tuple[Author, ...] = ()
    agreement_authors: Mapping[str, tuple[Author, ...]] = field(default_factory=dict)
    """Who wrote the commits that touch a partner's file of agreements, by that file."""
    agreed_hashes: Callable[[str], Mapping[tuple[str, str], str] | None] = lambda _: None
    """Returns what had changed when a file of agreements was written last: hashes by element and key, None if unknown."""
    trusts_mails: bool = True
    """Whether only people with a right to write could push the commits: not so in a request from a fork."""
    is_decided: bool = False
    """Whether the request was judged before, such as what waits in a merge queue, where nobody knows its author."""

    def stands_for(self, partner_id: str, partners: Mapping[str, Partner]) -> bool | None:
        """Whether who made the change stands for a partner; None where nobody can say. `partners` are those before it."""
        people = self.requesters or self.authors
        answers = [_is_reviewer(each, partner_id, partners, is_forge=bool(self.requesters)) for each in people]
        if self.requesters and answers[0] is False:
            return False
        return _combine(answers)

    def may_agree(self, file: str, partner_id: str, partners: Mapping[str, Partner]) -> bool:
        """Whether what stands newly in a partner's file of agreements may be the partner's own word."""
        requesters = [_is_reviewer(each, partner_id, partners, is_forge=True) for each in self.requesters]
        if True in requesters:
            return True
        mails = self.agreement_authors.get(file, ())
        writers = _combine([_is_reviewer(each, partner_id, partners, is_forge=False) for each in mails])
        if writers and (self.trusts_mails or not self.requesters):
            return True
        return writers is not False and False not in requesters


def _combine(answers: Iterable[bool | None]) -> bool | None:
    """Return what holds of several people: all of them stand for the partner, none does, or it cannot be said."""
    given = list(answers)
    if not given or (True in given and not all(given)):
        return None
    return True if True in given else False if False in given else None


def _is_reviewer(author: Author, partner_id: str, partners: Mapping[str, Partner], *, is_forge: bool) -> bool | None:
    """Whether a person is one of a partner's reviewers: not if that person is another's, or all are named otherwise.

    Who belongs to a team only the forge knows; whose an unknown e-mail address is, nobody.
    """
    handles = {name: frozenset(each.lower() for each in partner.reviewers) for name, partner in partners.items()}
    own_handles = handles.get(partner_id, frozenset[str]())
    if author & own_handles:
        return True
    if any(author & each for each in handles.values()):
        return False
    has_mail = any(not name.startswith("@") for name in author)
    has_team = any("/" in name or name.startswith("@@") for name in own_handles)
    is_told = any(name.startswith("@") or has_mail for name in own_handles) and not has_team
    return False if is_forge and is_told else None
