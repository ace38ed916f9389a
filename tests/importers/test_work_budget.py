"""What reading costs is paid from one budget; what is too much is told once, and is not charged."""

from __future__ import annotations

from archgen.importers.work_budget import WorkBudget


def test_steps_are_paid_until_there_are_none() -> None:
    budget = WorkBudget(10)
    assert [budget.pay(4) for _ in range(3)] == [True, True, False]
    assert budget.pay(2)
    assert budget.left == 0


def test_what_repeats_leaves_a_tenth_for_the_rest() -> None:
    budget = WorkBudget(100)
    assert budget.pay_to_repeat(90)
    assert not budget.pay_to_repeat()
    assert budget.pay(10)


def test_what_is_refused_costs_nothing() -> None:
    budget = WorkBudget(10)
    assert not budget.pay(11)
    assert budget.pay(10)


def test_more_that_is_read_has_more_steps() -> None:
    budget = WorkBudget(0)
    budget.add(20)
    assert budget.pay_to_repeat(18)
    assert not budget.pay_to_repeat()


def test_a_share_is_taken_from_what_is_around() -> None:
    budget = WorkBudget(100)
    half = budget.halve()
    assert (half.pay(50), half.pay(), budget.left) == (True, False, 50)
    share = WorkBudget(80, budget)
    assert (share.left, share.pay(60), share.pay(50), budget.left) == (50, False, True, 0)


def test_an_excess_is_told_once() -> None:
    budget = WorkBudget(1000)
    assert "more than the 1,000 steps that archgen follows" in budget.tell_excess()
    assert budget.tell_excess() == ""
