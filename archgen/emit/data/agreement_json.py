"""An agreement for programs: interfaces with their versions and terms, what is agreed in words, what is signed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.bringup.plan_shapes import StartStep
from archgen.diagnostics import format_json
from archgen.model.agreed_terms import find_agreement
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.general_sections import list_start_steps, list_variant_differences
from archgen.views.agreement.interface_record import InterfaceRecord
from archgen.views.agreement.interface_sections import list_word_rows

FORMAT_VERSION = 1


def write_agreement_json(content: AgreementContent) -> str:
    """Return an agreement as one JSON document."""
    architecture = content.lookup.architecture
    agreement = find_agreement(architecture.agreements, *content.pair)
    signed = agreement.signed
    steps = list_start_steps(architecture)
    return format_json(
        {
            "version": FORMAT_VERSION,
            "between": {name: architecture.partners[name].title for name in content.pair},
            "project": architecture.project.id,
            "revision": content.revision,
            "date": content.issue_date,
            "standing": list(content.standing),
            "terms": dict(agreement.terms),
            "interfaces": [_interface_record(content, record, steps) for record in content.records],
            "variants": {name: list(list_variant_differences(each)) for name, each in content.variant_changes.items()},
            "signed": {"tag": signed.tag, "revision": signed.revision, "by": dict(signed.by)} if signed else None,
        }
    )


def _interface_record(
    content: AgreementContent, record: InterfaceRecord, steps: Mapping[str, StartStep]
) -> dict[str, Any]:
    terms = record.terms
    words = list_word_rows(content.lookup, terms, steps)
    return {
        "id": record.key[0],
        "from": record.key[1][0],
        "to": record.key[1][1],
        "title": terms.title,
        "version": terms.version,
        "signed": content.signatures.versions.get(record.key),
        "terms": [
            {"name": term.name, "text": term.text, "promised": not term.is_expected}
            for key, term in record.plain_terms.items()
            if key
        ],
        "words": {
            row.key: {"agreed": row.written or None, "follows": list(row.derived), "unsaid": row.unsaid or None}
            for row in words
        },
        "open": list(terms.open_points),
    }
