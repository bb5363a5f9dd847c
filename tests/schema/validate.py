"""Judges documents by a JSON Schema of draft 2020-12.

    validate.py SCHEMA < DOCUMENTS

DOCUMENTS has one JSON document a line. Prints for each a line: nothing where it is valid, else where and why it is not.
"""
import json
import sys

from jsonschema import Draft202012Validator

with open(sys.argv[1], encoding="utf-8") as file:
    schema = json.load(file)
Draft202012Validator.check_schema(schema)
validator = Draft202012Validator(schema)
for line in sys.stdin:
    # The first of them: to look for the one that says most takes half as long again.
    fault = next(validator.iter_errors(json.loads(line)), None)
    print("" if fault is None else f"{fault.json_path}: {fault.message}".replace("\n", " ")[:200])
