"""partialslip verify: judge the methods on shipped scenes, hard cases or random scenes, and write a report."""

import argparse

from partialslip.cli.common import Commands, add_method, add_out, add_pdf, add_verbose, check_output, print_written

_SUITES = ("quick", "full", "book", "stress")


def add(commands: Commands) -> None:
    """Add the command to the parser of ``commands``."""
    verify = commands.add_parser(
        "verify",
        help="judge the methods on shipped scenes, hard cases or random scenes",
        description="Solve scenes by every method, judge the results against the bars, and write a report. An "
        "interrupted run continues.",
        examples=[
            "partialslip verify",
            "partialslip verify --suite full --only near-sliding-1e-6",
            "partialslip verify --suite stress --count 1000 --seed 0 --with march",
        ],
        failure="a bar missed",
        unjudged="headline quantities not judged",
    )
    verify.add_argument("--suite", choices=_SUITES, default="quick",
                        help="quick: shipped scenes; full: shipped scenes and hard cases; book: problems of the "
                        "benchmark; stress: random scenes (default: quick)")  # fmt: skip
    verify.add_argument("--only", action="append", default=[], metavar="NAME",
                        help="only this case, wildcards * and ?; for random scenes the number; may be "
                        "repeated")  # fmt: skip
    verify.add_argument("--count", type=int, metavar="N", help="stress: number of scenes (default: 100)")
    verify.add_argument("--seed", type=int, metavar="S", help="stress: seed of the scenes (default: 0)")
    add_method(verify, "stress: exact, march or fem (default: exact)")
    verify.add_argument("--processes", type=int, metavar="N",
                        help="parallel processes (default: number of cores)")  # fmt: skip
    verify.add_argument("--include", action="append", default=[], metavar="DIR",
                        help="folder of a study (see: partialslip study); the figures are put into the report; may be "
                        "repeated")  # fmt: skip
    verify.add_argument("--ladder", action="store_true",
                        help="add a refinement ladder to each scene, with observed orders and grid convergence indices "
                        "(about 5 CPU seconds a scene)")  # fmt: skip
    for field, what in (("project", "project"), ("author", "author"), ("reviewer", "reviewer"),
                        ("document", "document number")):  # fmt: skip
        verify.add_argument(f"--{field}", default="", metavar="TEXT", help=f"{what}, for the title block of the report")
    add_out(verify, "results/verify-SUITE[-HASH]")
    add_pdf(verify)
    add_verbose(verify, "one row for each case and method, also if there are many and nothing is missed")
    verify.set_defaults(command=_verify)


def _verify(options: argparse.Namespace) -> int:
    check_output(options)

    from partialslip.cli.consoles import counting, output
    from partialslip.verify.driver import verify_suite
    from partialslip.verify.entry import TitleBlock
    from partialslip.verify.verdicts import print_verdicts

    with counting(f"verify {options.suite}", "writing the report") as progress:
        verified = verify_suite(
            options.suite,
            options.only,
            method=options.method,
            seed=options.seed,
            count=options.count,
            processes=options.processes,
            out=options.out,
            force=options.force,
            include=options.include,
            ladder=options.ladder,
            pdf=options.pdf,
            block=TitleBlock(options.project, options.author, options.reviewer, options.document),
            progress=progress,
        )
    console = output()
    print_verdicts(verified.verdicts, console, every=options.verbose)
    if verified.again:
        console.print(
            f"solved again, as the scene, its settings or the program have changed: {', '.join(verified.again)}",
            soft_wrap=True,
            markup=False,
        )
    print_written(verified.files, console, verified.elsewhere)
    return verified.conclusion.code
