"""Hard cases: scenes on which codes go wrong, each with its bars and the reason."""
