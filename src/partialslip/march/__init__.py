"""Marching in time: half-planes through any load history, step by step or event by event."""
