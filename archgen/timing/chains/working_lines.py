"""The workings of responses and links as sentences: each term with its factors, so that all can be followed by hand."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import NamedTuple, dataclass
from archgen.timing.figures import figure_wording
from archgen.timing.load.work_terms import ANY_AMOUNT, FigureWorking, ThreadShare, WorkTerm
from archgen.timing.rates.link_traffic import LinkWorking


class ReasonLine(NamedTuple):
    """One step of the reasoning; deeper lines support the one above them."""

    depth: int
    text: str
    at: Span = NO_SPAN


@dataclass(frozen=True, slots=True)
class WorkingLines:
    """Writes workings; durations in them are in ticks of `tick` ns."""

    tick: Fraction

    def _write(self, ticks: int | Fraction) -> str:
        return figure_wording.format_duration(ticks * self.tick)

    def explain_response(self, working: FigureWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield how a response, or the time of a run, comes about."""
        if working.addends:
            parts = " + ".join(self._write(each.value) for each in working.addends)
            before, last = " > ".join(working.steps[:-1]), working.steps[-1]
            yield ReasonLine(depth, f"{parts} = {self._write(working.value)}: first {before}, then {last}")
            for addend in working.addends:
                yield from self.explain_response(addend, depth + 1)
            return
        if working.core_count > 1 or working.leads:
            yield from self._explain_shared(working, depth)
        else:
            has_counts = any(term.events.formula != str(term.events.number) for term in working.terms)
            counts_text = "; of each ceil((t + how much later it may come) / how often)" if has_counts else ""
            core_text = f", on core {working.core} alone" if working.core is not None else ""
            head = (
                "the longest t in which there may be work all the time, until an activation that comes too soon,"
                if working.is_hold
                else f"the least t > 0 in which all of this is done{core_text}"
            )
            if working.is_queue:
                head, counts_text = "what is done in the queue until its end, its own work included,", ""
            yield ReasonLine(depth, f"{head} is {self._write(working.window)}{counts_text}:")
            yield from self.list_terms(working.terms, depth + 1)
            yield from self._sum_up([self._write(term.total) for term in working.terms], working.window, depth + 1)
        yield from self._explain_rest(working, depth)

    def _explain_shared(self, working: FigureWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield A, the work of the threads that are waited for, and B, in which all cores are busy with others."""
        own_work = sum(term.total for term in working.terms)
        head = (
            "the longest t with A + B >= t, until an activation that comes too soon,"
            if working.is_hold
            else "the least t > 0 with A + B <= t"
        )
        beside = f"B the time in which all {working.core_count} cores may be busy with others"
        if working.leads:
            beside, head = "F what others are served before it on its core", head.replace("B", "F")
        yield ReasonLine(
            depth, f"{head} is {self._write(working.window)}: A is the work of its own threads, {beside}"
        )  # fmt: skip
        yield from self.list_terms(working.terms, depth + 1)
        parts = [self._write(term.total) for term in working.terms]
        sum_text = f" = {self._write(own_work)}" if len(parts) > 1 else ""
        yield ReasonLine(depth + 1, f"A = {' + '.join(parts)}{sum_text}" if parts else "A = 0 ms")
        if working.leads:
            yield from self._explain_serving(working, own_work, depth + 1)
        elif working.blocked_time:
            yield from self._explain_blocking(working, depth + 1)
        else:
            count = len(working.shares)
            others = f"the {count} other threads that have work" if count else "no other thread has work, which"
            yield ReasonLine(depth + 1, f"B = 0 ms: {others} cannot keep {working.core_count} cores busy all at once")
        relation = "=" if working.work == working.window else "<=" if working.work < working.window else ">="
        yield ReasonLine(
            depth + 1,
            f"{self._write(own_work)} + {self._write(working.blocked_time)} {relation} {self._write(working.window)}, A + {'F' if working.leads else 'B'}{' until then' if working.is_hold else ''}",
        )

    def _explain_serving(self, working: FigureWorking, own_work: int, depth: int) -> Iterator[ReasonLine]:
        """Yield what others are served before a thread that shares its core fairly: no thread more than A and a lead."""
        yield from self.list_terms(working.beside_terms, depth)
        leads = f"{len(working.leads)} x " if len(working.leads) > 1 else ""
        cut = self._write(own_work + sum(working.leads))
        yield ReasonLine(
            depth,
            f"no other thread is served more than {self._write(own_work)} + {leads}{self._write(working.leads[0])} = {cut}, "
            f"A and a lead{' for each job' if leads else ''}{self._describe_cuts(working.shares, 'that')}",
        )
        parts = [f"{self._write(share.counted)} {'/'.join(share.unit)}" for share in working.shares]
        yield ReasonLine(
            depth, " = ".join(["F", *filter(None, (" + ".join(parts),)), self._write(working.blocked_time)])
        )

    def _explain_blocking(self, working: FigureWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield what all cores may be busy with: what comes, thread by thread, and what is pending from before."""
        yield from self.list_terms(working.beside_terms, depth)
        if working.is_backlog:
            yield from self._explain_backlog(working, depth)
            return
        parts = [f"{self._write(share.counted)} {'/'.join(share.unit)}" for share in working.shares]
        parts += [f"{self._write(working.pending)} pending"] if working.pending else []
        yield ReasonLine(
            depth,
            f"B = ({' + '.join(parts)}) / {working.core_count} = {self._write(working.blocked_time)}, what each of "
            f"{len(working.shares)} other threads has to do{self._describe_cuts(working.shares)}",
        )
        if working.pending:
            yield ReasonLine(
                depth + 1,
                f"{self._write(working.pending)} pending: what may be left over from before (carry-in), as at most "
                f"{working.core_count - 1} threads had work when the last core became busy",
            )

    def _explain_backlog(self, working: FigureWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield what was pending when a core was idle last, and what of all that may be done before the figure ends."""
        yield from self.list_terms(working.pending_terms, depth)
        parts = [self._write(term.total) for term in (*working.beside_terms, *working.pending_terms)]
        own_work = sum(term.total for term in working.terms) - working.thread_wait
        left_parts = [self._write(ticks) for ticks in (own_work, working.unfinished) if ticks]
        left_text = "".join(f" - {part}" for part in left_parts)
        yield ReasonLine(
            depth,
            f"B = ({' + '.join(parts)}{left_text}) / {working.core_count} = {self._write(working.blocked_time)}: what comes, and "
            f"{self._write(working.pending)} that may have been pending when a core was idle last, without "
            f"{'the work in A' if working.thread_wait else 'A'}"
            f"{' and what is done after this' if working.unfinished else ''}",
        )

    def _describe_cuts(self, shares: Iterable[ThreadShare], word: str = "B") -> str:
        cuts = [share for share in shares if share.counted < share.work]
        if not cuts:
            return ""
        names = ", ".join(
            f"{' '.join(share.unit)} ({'any amount' if share.work >= ANY_AMOUNT else self._write(share.work)})"
            for share in cuts
        )
        return f", but none for longer than {word}: {names}" if word == "B" else f"; more to do have {names}"

    def _explain_rest(self, working: FigureWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield what is taken off the window, where it does not begin with the activation."""
        if not working.arrival and not working.lead:
            return
        parts = [self._write(working.window)]
        reasons: list[str] = []
        if working.arrival:
            parts.append(self._write(working.arrival))
            who = "it" if working.is_queue else f"activation {working.activation}"
            reasons.append(f"{who} comes {parts[-1]} after the first at the earliest")
        if working.lead:
            parts.append(self._write(working.lead))
            reasons.append(
                f"t begins with the event, and {working.steps[-1]} {parts[-1]} after it at the earliest"
                if working.steps
                else f"t begins with the event, {parts[-1]} before the activation at least"
            )
        yield ReasonLine(depth, f"{' - '.join(parts)} = {self._write(working.value)}: {', and '.join(reasons)}")

    def list_terms(self, terms: Iterable[WorkTerm], depth: int) -> Iterator[ReasonLine]:
        """Yield terms: `3 x (2 ms scanner + 5 ms boxes) = 21 ms, since ceil((44 ms + 1 ms) / 40 ms) = 3`."""
        for term in terms:
            costs = _join_parts([f"{self._write(cost)} {name}" for name, cost in term.parts])
            number, formula = term.events
            reason = f", {term.reason}" if term.reason else ""
            because = "" if formula == str(number) else f", since {formula} = {number}"
            yield ReasonLine(depth, f"{number} x {costs} = {self._write(term.total)}{because}{reason}")

    def _sum_up(self, parts: list[str], total: int, depth: int) -> Iterator[ReasonLine]:
        if len(parts) > 1:
            yield ReasonLine(depth, f"{' + '.join(parts)} = {self._write(total)}")

    def explain_link(self, working: LinkWorking, depth: int) -> Iterator[ReasonLine]:
        """Yield how the queueing and the largest burst of a link come about."""
        write_size = figure_wording.format_size
        speed = f"{write_size(working.bandwidth)}/s"
        yield ReasonLine(
            depth,
            f"the least t > 0 in which all is sent that comes in t, at {speed}, is {self._write(working.window)}:",
        )
        yield from self.list_terms(working.terms, depth + 1)
        yield from self._sum_up([self._write(term.total) for term in working.terms], working.window, depth + 1)
        burst = Fraction(working.burst)
        when = f"{self._write(working.time)} after the first messages" if working.time else "all that comes at once"
        yield ReasonLine(
            depth,
            f"{write_size(burst)} / {speed} = {figure_wording.format_duration(burst / working.bandwidth * 10**9)}"
            f" for the largest burst alone, {when}:",
        )
        for term in working.burst_terms:
            sizes = _join_parts([f"{write_size(Fraction(size))} {name}" for name, size in term.parts])
            yield ReasonLine(depth + 1, f"{term.events.number} x {sizes} = {write_size(Fraction(term.total))}")
        if working.time:
            sent = working.bandwidth * working.time * self.tick / 10**9
            yield ReasonLine(depth + 1, f"{self._write(working.time)} x {speed} = {write_size(sent)} are sent by then")
        if len(working.burst_terms) == 1 and not working.time:
            return
        totals = " + ".join(write_size(Fraction(term.total)) for term in working.burst_terms)
        sent_text = f" - {write_size(working.bandwidth * working.time * self.tick / 10**9)}" if working.time else ""
        yield ReasonLine(depth + 1, f"{totals}{sent_text} = {write_size(burst)}")


def _join_parts(parts: Iterable[str]) -> str:
    """Write a sum in brackets, equal parts as a product; one part alone as it is."""
    numbers: dict[str, int] = {}
    for part in parts:
        numbers[part] = numbers.get(part, 0) + 1
    products = [part if number == 1 else f"{number} x {part}" for part, number in numbers.items()]
    return products[0] if len(products) == 1 else f"({' + '.join(products)})"
