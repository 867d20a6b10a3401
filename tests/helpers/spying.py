"""What functions are called with."""


def spied(monkeypatch, owner, name):
    """Arguments of all calls of the ``owner``'s function from now on, which does what it did."""
    true, given = getattr(owner, name), []
    monkeypatch.setattr(owner, name, lambda *args, **named: given.append(args) or true(*args, **named))
    return given
