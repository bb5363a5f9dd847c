"""Holds what a job left to what the commit should give.

    check_report.py FOLDER VERDICT COMMIT JUNIT_XSD [FILE...]

FOLDER has report.json, junit.xml, every picture that report.json names, and the FILEs. junit.xml fits the schema, and a reader
of JUnit files counts in it what report.json says.
"""

import json
import os
import sys
from pathlib import Path

from junitparser import JUnitXml
from lxml import etree

EXIT_CODES = {"same": 0, "warning": 1, "failure": 2}


def expect(what, value, expected):
    if value != expected:
        sys.exit(f"{what} is {value}; expected: {expected}")


def check_report(folder, verdict, commit):
    report = json.loads((folder / "report.json").read_text())
    expect("verdict", report["verdict"], verdict)
    expect("exit_code", report["exit_code"], EXIT_CODES[verdict])
    expect("commit", report["environment"]["commit"], commit)
    expect("backend", report["environment"]["backend"], "software")
    expect("cases", report["counts"]["cases"], 10)
    expect("cases passed", report["counts"]["passed"], 10 if verdict == "same" else 9)
    expect("cases skipped", report["counts"]["skipped"], 0)
    pictures = [picture for case in report["cases"] for image in case["images"]
                for picture in image["pictures"].values() if isinstance(picture, str)]
    absent = [picture for picture in pictures if not (folder / picture).exists()]
    expect("pictures that are absent", absent, [])
    return report, len(pictures)


def check_junit(file, schema, counts):
    etree.XMLSchema(file=schema).assertValid(etree.parse(file))
    junit = JUnitXml.fromfile(str(file))
    suites = list(junit)
    cases = [case for suite in suites for case in suite]
    expect("testsuites of junit.xml", len(suites), 1)
    expect("testcases of junit.xml", len(cases), counts["cases"])
    expect("failed testcases of junit.xml", sum(not case.is_passed for case in cases), counts["failed"])
    expect("failures of junit.xml", suites[0].failures, counts["failed"])


def main():
    folder, verdict, commit, schema = Path(sys.argv[1]), *sys.argv[2:5]
    report, pictures = check_report(folder, verdict, commit)
    check_junit(folder / "junit.xml", schema, report["counts"])
    for file in sys.argv[5:]:
        expect(f"{file} there", (folder / file).exists(), True)
    limit_s = float(os.environ.get("LIMIT_S", "10"))
    expect(f"golden run above {limit_s:.0f} s, with {report['seconds']:.1f} s,", report["seconds"] > limit_s, False)
    print(f"report: {verdict}, ten cases in {report['seconds']:.2f} s, commit {commit[:10]}, {pictures} pictures; junit.xml is valid")


main()
