"""Solve many cases, here or on a cluster. Each finished case is saved at once, so that a stopped study can continue."""
