"""What was made of an object last is not made again, and of another one it is."""

from __future__ import annotations

import threading

from archgen.model.latest_result import remember_latest


def test_only_the_latest_object_is_remembered_and_by_identity() -> None:
    asked: list[int] = []

    @remember_latest
    def add_up(numbers: list[int]) -> int:
        asked.append(id(numbers))
        return sum(numbers)

    first, equal = [1, 2], [1, 2]
    assert [add_up(each) for each in (first, first, equal, equal, first)] == [3] * 5
    assert asked == [id(first), id(equal), id(first)]


def test_each_thread_remembers_by_itself() -> None:
    makers: list[int] = []

    @remember_latest
    def note_thread(_: object) -> None:
        makers.append(threading.get_ident())

    argument = object()
    thread = threading.Thread(target=note_thread, args=(argument,))
    note_thread(argument)
    thread.start()
    thread.join(timeout=10)
    note_thread(argument)
    assert len(makers) == 2
