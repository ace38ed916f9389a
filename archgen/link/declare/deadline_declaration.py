"""Declare the deadline of a chain: always, and for shares of its reactions. The only place that knows its forms."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import pairwise

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import Span
from archgen.link import sanity_checks
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.quantity import Quantity, parse_share, write_share
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

ALWAYS = "always"
_LARGEST_SHARE = Fraction(999_999, 1_000_000)
"""To see what is later than a larger one takes more than a million reactions, which nobody simulates or records."""


def read_deadline(
    body: MappingNode, key: str, chain_id: str, resolver: ReferenceResolver
) -> tuple[Quantity | None, Mapping[str, Quantity], Mapping[str, Span]]:
    """Return the deadline that always holds; those of shares of the reactions, the smallest share first, and their places."""
    node, diagnostics = body.get(key), resolver.diagnostics
    if not isinstance(node, MappingNode):
        return sanity_checks.read_positive(body, key, "duration", chain_id, diagnostics), {}, {}
    always = sanity_checks.read_positive(node, ALWAYS, "duration", chain_id, diagnostics)
    entries = dict(sorted(_read_shares(node, chain_id, diagnostics)))
    limits = {
        share: quantity
        for share, entry in entries.items()
        if (quantity := sanity_checks.read_positive(node, entry.key, "duration", chain_id, diagnostics)) is not None
    }
    rising = [*((entries[share].key, limit) for share, limit in limits.items()), (ALWAYS, always)]
    if any(
        sanity_checks.report_exchanged(node, smaller, larger, chain_id, diagnostics)
        for smaller, larger in pairwise(rising)
    ):
        return always, {}, {}
    names = {share: write_share(share) for share in limits}
    return (
        always,
        {name: limits[share] for share, name in names.items()},
        {name: entries[share].key_span for share, name in names.items()},
    )


def _read_shares(
    node: MappingNode, chain_id: str, diagnostics: list[Diagnostic]
) -> Iterator[tuple[Fraction, MappingEntry]]:
    """Yield the entries of shares that something can be said of, each share once; the others are reported."""
    seen_spans: dict[Fraction, Span] = {}
    for entry in node:
        share = parse_share(entry.key)
        # A key that is no share is reported by the schema, and a duration that is none as well.
        if share is None:
            continue
        if share in seen_spans:
            message, help_line = f"`{entry.key}` is written twice", "take one of them out"
        elif not share:
            message, help_line = "0 % of the reactions ask for nothing", "write a share above 0 %, such as `95 %`"
        elif share > _LARGEST_SHARE:
            message = f"no data can judge `{entry.key}`: fewer than one of a million reactions may be later"
            help_line = f"write 99.9999 % at most, or `{ALWAYS}`, which bounds judge"
        else:
            seen_spans[share] = entry.key_span
            yield share, entry
            continue
        labels = (Label(seen_spans[share], "first written here"),) if share in seen_spans else ()
        diagnostics.append(
            Diagnostic("wrong-value", message, entry.key_span, labels=labels, help=help_line, element=chain_id)
        )
