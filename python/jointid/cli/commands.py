"""Commands `demo`, `identify`, `compare` and `report`; slow imports stay inside the functions."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from jointid.base.errors import InputError
from jointid.cli.arguments import with_terms
from jointid.cli.exit_codes import BAD_INPUT
from jointid.cli.joint_options import joint_file, joint_of, torque_needed
from jointid.cli.options import stated_options
from jointid.cli.outputs import (
    check_output_folder,
    check_outputs,
    check_page,
    estimate_file,
    say_written,
)
from jointid.cli.reading import joints_wanted, load_all
from jointid.cli.requirement import required
from jointid.cli.wording import ADVICE, Wording

if TYPE_CHECKING:
    from pathlib import Path

    from jointid.base.result import Result
    from jointid.comparison.result import Comparison
    from jointid.estimate.bootstrap import Bootstrap
    from jointid.estimate.causes import Causes
    from jointid.estimate.estimate import Estimate
    from jointid.estimate.self_test import SelfTest
    from jointid.recording.recording import Recording


def demo(arguments: argparse.Namespace) -> None:
    """Identify the joint that ships with the package."""
    from jointid.base.files import make_folder
    from jointid.cli.demonstration import demo as demonstration
    from jointid.identification.identification import identify as identified
    from jointid.report.saving import save_report

    check_output_folder("output", arguments.output)
    kuka = demonstration()
    estimate = identified(kuka.recording, kuka.joint)
    make_folder(arguments.output)
    saved = arguments.output / "estimate.json"
    estimate.save(saved)
    wording = replace(Wording.of(arguments), saved=str(saved))
    page = save_report(
        estimate,
        arguments.output / "report.html",
        action=wording.of_command,
        recordings=kuka.recording,
    )
    if arguments.json:
        print(estimate.to_json())
        return
    print(wording.of_answer(estimate, verbose=arguments.verbose))
    published = ", ".join(
        f"{name} {nominal:g} {estimate.parameters[name].unit}"
        for name, nominal in kuka.published.items()
    )
    print(f"published: {published}")
    print(f"report: {page}   estimate: {saved}")


def identify(arguments: argparse.Namespace) -> int:
    """Identify a joint from one recording or several."""
    from jointid._core import GaOptions
    from jointid.cli.progress import Progress
    from jointid.identification import identification
    from jointid.identification.search.search import Search

    if arguments.robot is not None:
        from jointid.cli.robot import identify_whole_robot

        return identify_whole_robot(arguments)
    _for_one_joint(arguments)
    several = joints_wanted(arguments)
    if several is not None and len(several) != 1:
        from jointid.cli.joints import identify_several

        return identify_several(arguments, several)
    options = stated_options(arguments)
    check_outputs(arguments)
    budget = {
        name: getattr(arguments, name)
        for name in ("population", "generations")
        if getattr(arguments, name) is not None
    }
    file = joint_file(arguments)
    if file is not None and file.voltage is not None:
        from jointid.cli.servo import identify_runs

        return identify_runs(arguments, file)
    _for_a_torque(arguments)
    model = with_terms(arguments.model, arguments)
    merged = model if file is None else model.over(file.model)
    usable = torque_needed(arguments, file)
    try:
        recordings = load_all(arguments.recordings, arguments, [merged], usable=usable)
    except InputError as error:
        from jointid.cli.friction_map import printed_map

        printed_map(arguments.recordings, arguments, error)
        return 0
    joint = joint_of(arguments, file, recordings)
    search = Search(
        arguments.method,
        ga=GaOptions(**budget) if budget else None,
        seed=arguments.seed,
        threads=arguments.threads,
        checkpoint=arguments.checkpoint,
        resume=arguments.resume,
    )
    with Progress(total=search.genetic.generations, enabled=not arguments.quiet) as progress:
        if search.chosen_method != "separable":  # it has no generations
            search = replace(search, callback=progress)
        estimate = identification.identify(
            recordings,
            joint,
            model=model,
            search=search,
            **options,
        )
    tested = estimate.selftest(seed=arguments.seed) if arguments.selftest else None
    draws = arguments.bootstrap
    drawn = estimate.bootstrap(draws, arguments.seed) if draws is not None else None
    causes = estimate.causes() if arguments.causes else None
    refused = _write(estimate, arguments, recordings=recordings)
    if arguments.json:
        print(_with_checks(estimate, {"selftest": tested, "bootstrap": drawn, "causes": causes}))
    else:
        print(Wording.of(arguments).of_answer(estimate, verbose=arguments.verbose))
        for check in (tested, drawn):
            if check is not None:
                print(f"\n{check.report()}")
        if causes is not None:
            print(f"\n{causes.report(Wording.of(arguments).of_action)}")
    _say_written(refused, arguments)
    return required({"": estimate.verdict}, arguments) or _exit_code(refused, arguments)


def _with_checks(
    estimate: Estimate, checks: Mapping[str, SelfTest | Bootstrap | Causes | None]
) -> str:
    """Return the estimate as JSON, with the results of the requested checks."""
    done = {name: check.document() for name, check in checks.items() if check is not None}
    if not done:
        return estimate.to_json()
    import json

    document = json.loads(estimate.to_json()) | done
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False)


def _for_one_joint(arguments: argparse.Namespace) -> None:
    if arguments.facts is not None:
        raise InputError("this option is for a robot; name its URDF with --robot", argument="facts")


def _for_a_torque(arguments: argparse.Namespace) -> None:
    for name in ("by", "rollout"):
        if getattr(arguments, name):
            raise InputError(
                'this option is for a servo: its joint file has input = "voltage" in [drive]',
                argument=name,
            )


def compare(arguments: argparse.Namespace) -> int:
    """Compare models by how well they predict held-out motion."""
    from jointid.cli.progress import ComparisonProgress
    from jointid.comparison.comparison import compare_models
    from jointid.identification.search.search import Search
    from jointid.joint.model import Model

    if arguments.robot is not None:
        from jointid.cli.robot import compare_whole_robot

        return compare_whole_robot(arguments)
    _for_one_joint(arguments)
    options = stated_options(arguments)
    check_outputs(arguments)
    file = joint_file(arguments)
    models = arguments.models
    if arguments.terms:
        models = [with_terms(text, arguments) for text in models or ("coulomb_viscous", "stribeck")]
    merged = [Model.of(each) for each in models or (None,)]
    merged = [each if file is None else each.over(file.model) for each in merged]
    usable = torque_needed(arguments, file)
    recordings = load_all(arguments.recordings, arguments, merged, usable=usable)
    joint = joint_of(arguments, file, recordings)
    with ComparisonProgress(enabled=not arguments.quiet) as progress:
        comparison = compare_models(
            recordings,
            joint,
            models=models,
            folds=arguments.folds,
            search=Search(arguments.method, seed=arguments.seed, threads=arguments.threads),
            callback=progress,
            **options,
        )
    refused = _write(comparison.estimate, arguments, comparison)
    wording = Wording.of(arguments)
    saved = "" if wording.saved == "ESTIMATE" else wording.saved
    print(
        comparison.to_json()
        if arguments.json
        else comparison.report(wording.of_command, saved, verbose=arguments.verbose)
    )
    _say_written(refused, arguments)
    return _exit_code(refused, arguments)


def report(arguments: argparse.Namespace) -> None:
    """Write the page of a saved result."""
    import json

    from jointid.report.saving import save_report

    check_page("output", arguments.output)
    result = _saved(arguments.estimate, arguments.joints)
    page = save_report(result, arguments.output, action=ADVICE.of_action)
    if arguments.json:
        found = [each for each in result.overview.findings if each.severity != "info"]
        summary = {"report": str(page), "warnings": [each.code for each in found]}
        print(json.dumps(summary, indent=1, ensure_ascii=False))
    else:
        print(f"report: {page}")


def _saved(path: Path, joint: str | None) -> Result:
    """Return the result in a file, of any kind. `joint` names one of several joints."""
    from jointid.base.result import Result
    from jointid.joints.reading import load_estimate
    from jointid.verbs.result_kinds import class_of_kind

    try:
        kind = class_of_kind(path)
    except InputError:
        return load_estimate(path, joint)  # its error names the problem
    if kind.__name__ in ("Estimate", "JointEstimates") and joint is not None:
        return load_estimate(path, joint)
    if joint is not None:
        raise InputError("the page of a robot shows all joints", argument="joints", value=joint)
    return Result.load(path)


def _write(
    estimate: Estimate,
    arguments: argparse.Namespace,
    comparison: Comparison | None = None,
    recordings: Sequence[Recording] | None = None,
) -> str:
    """Write the requested files. Return the code of a finding that prevents a joint file.

    The next session uses a joint file without a check. Therefore values that cannot be used are not written to it.
    """
    if arguments.report is not None:
        from jointid.report.saving import save_report

        save_report(
            comparison or estimate,
            arguments.report,
            action=Wording.of(arguments).of_command,
            recordings=recordings,
        )
    saved = estimate_file(arguments)
    if saved is not None:
        estimate.save(saved)
    blocking = [each.code for each in estimate.findings if each.severity == "blocking"]
    if arguments.save is None or arguments.save == saved:
        return ""
    if blocking:
        return blocking[0]
    estimate.save(arguments.save)
    return ""


def _say_written(refused: str, arguments: argparse.Namespace) -> None:
    """Print after the report which files were written; with --json print nothing."""
    saved = estimate_file(arguments)
    joint = arguments.save if not refused and arguments.save != saved else None
    if not arguments.json:
        say_written(report=arguments.report, estimate=saved, joint_file=joint)


def _exit_code(refused: str, arguments: argparse.Namespace) -> int:
    """Print after the report which joint file was not written, and why."""
    if not refused:
        return 0
    print(
        f"jointid {arguments.command}: the finding {refused} is blocking: {arguments.save} was not "
        "written; --save estimate.json keeps the result",
        file=sys.stderr,
    )
    return BAD_INPUT
