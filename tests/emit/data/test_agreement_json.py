"""Agreements for programs."""

from __future__ import annotations

import json
from pathlib import Path

from archgen.emit.data.agreement_json import write_agreement_json
from archgen.views.agreement.partner_agreement import make_agreement
from tests.agreeing import DUO, checked, view


def test_it_says_what_the_document_says(tmp_path: Path) -> None:
    words = """\
agreements:
  south-north:
    terms: {notice: 30 days, late: It stops.}
    signed: {tag: t, by: {north: Ada}}
"""
    data = json.loads(
        write_agreement_json(make_agreement(view(checked(tmp_path, DUO + words)), "north", "south").content)
    )
    assert data["between"] == {"north": "North Robotics", "south": "South Vision"}
    assert (data["terms"], data["signed"]) == (
        {"notice": "30 days", "late": "It stops."},
        {"tag": "t", "revision": None, "by": {"north": "Ada"}},
    )
    plan, _, found = data["interfaces"]
    assert (plan["id"], plan["from"], plan["to"]) == ("moving.planner.plan", "north", "south")
    assert found["words"] == {
        "late": {"agreed": "It stops.", "follows": [], "unsaid": None},
        "stamps": {
            "agreed": None,
            "follows": [],
            "unsaid": "nothing is said of whether header.stamp is of measuring or of sending",
        },
        "clock": {"agreed": None, "follows": ["The clock of Pc, on which both sides run."], "unsaid": None},
        "start": {"agreed": None, "follows": [], "unsaid": "nothing is said of it"},
        "duties": {"agreed": None, "follows": [], "unsaid": "nothing is said of it"},
    }
    assert {"name": "QoS offered (promised)", "text": "default: reliable, depth 10", "promised": True} in found["terms"]
