"""Hard cases: scenes on which contact codes may fail, with bars and reasons."""
