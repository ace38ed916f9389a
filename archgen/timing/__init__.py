"""Timing: rates, response times, latency, load and bandwidth, from sources to sinks, with exact arithmetic.

`system` reads the activities and the arcs between them off an architecture; `analysis` holds what follows from them.
"""
