"""Frictional contact condensed to the contact line: a small dense problem, whatever the compliances come from."""
