"""An interface of one revision, as it is shown and compared."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from archgen.frozen import dataclass
from archgen.model.partner_interfaces import PartnerPair
from archgen.views.agreement.interface_terms import InterfaceTerms

if TYPE_CHECKING:  # not for each site: comparisons are large, and most are compared with nothing
    from archgen.views.agreement.plain_terms import PlainTerm

InterfaceKey = tuple[str, PartnerPair]
"""What identifies an interface: what flows, and between whom, by the ids of the later revision."""


@dataclass(frozen=True, slots=True)
class InterfaceRecord:
    """An interface of one revision with its terms as plain text. `key` has the ids of the later revision."""

    terms: InterfaceTerms
    key: InterfaceKey
    plain_terms: Mapping[str, PlainTerm]
