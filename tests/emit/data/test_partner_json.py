"""What rests on a partner, for programs."""

from __future__ import annotations

from pathlib import Path

from archgen.emit.data.partner_json import impact_to_json
from archgen.products.agreement_documents import make_timed_lookup
from archgen.views.agreement.exchange_tables import gather_exchanges
from archgen.views.reliance.partner_impact import find_impact, find_parts_of
from tests.late_robot import check


def test_all_facts_are_there_by_ids(tmp_path: Path) -> None:
    lookup = make_timed_lookup(check(tmp_path))
    late = find_parts_of(lookup, lookup.architecture.partners["south"])
    data = impact_to_json(find_impact(lookup, gather_exchanges(lookup), late))
    assert (data["version"], data["partner"], data["components"]) == (1, "south", ["g.brain"])
    assert data["chains"][0]["deadline"]["value"] == 400
    assert data["use_cases"] == [{"id": "UC-1", "steps": ["runs", "theirs", "theirs", "never"], "stops_at": 2}]
    assert data["requirements"] == [{"id": "R-1", "others": ["g.eye"]}, {"id": "R-2", "others": ["g.mouth"]}]
    assert [each["id"] for each in data["interfaces"]] == ["g.brain.word", "g.brain.ask"]
    assert data["waits_for"] == {"north": 2}
