"""The exact steady state under gradual loads in phase, at constant pressure (docs/theory.md, section 7)."""
