"""The study of effects: changes and costs caused by each effect."""
