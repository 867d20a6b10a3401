"""Hard cases: scenes on which contact codes fail, with bars and reasons."""
