"""What each effect is worth and what it costs: the study of effects."""
