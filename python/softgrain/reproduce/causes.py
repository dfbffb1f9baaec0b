"""Why a statement of the paper and our number differ: the one ingredient that was changed to find out."""

AS_STATED = "agrees as stated"
CONTACT_RULE = "agrees with the paper's own contact rule"
SLOW_WALL = "agrees with a slow wall"
LAW = "agrees with another law of the grain"
DEFINITION = "agrees by another definition"
ARITHMETIC = "differs by the paper's own arithmetic"
OPEN = "open"
ALL = (AS_STATED, CONTACT_RULE, SLOW_WALL, LAW, DEFINITION, ARITHMETIC, OPEN)


def counts(verdicts):
    """{cause: how many}, in the order above, none left out that occurs."""
    return {cause: number for cause in ALL if (number := sum(v.cause == cause for v in verdicts))}


def headline(verdicts):
    """One line for people: "29 statements: 14 agree as stated; ..."."""
    return f"{len(verdicts)} statements: " + "; ".join(
        f"{number} {cause.replace('agrees', 'agree').replace('differs', 'differ')}" for cause, number in counts(verdicts).items())
