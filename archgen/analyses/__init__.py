"""Analyses: pure functions that compute, and right below each the rule that judges."""
