"""What a golden run's --json says of its images: how many are equal to the bit, pass by tolerance, or fail; names those
that are not equal. For scripts/check distributions.

    golden_images.py REPORT.json
"""
import json
import sys

report = json.load(open(sys.argv[1]))
images = [(case["name"], image) for case in report["cases"] for image in case["images"]]
equal = sum(image["bits_equal"] for _, image in images)
failed = [name for name, image in images if image["verdict"] not in ("same", "warning")]
within = [name for name, image in images if not image["bits_equal"] and name not in failed]
text = f"{equal} of {len(images)} equal to the bit"
if within:
    text += f"; within tolerance: {', '.join(within)}"
if failed:
    text += f"; failed: {', '.join(failed)}"
print(text)
