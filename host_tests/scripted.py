"""Run the test_ functions of a script and print Unity's summary line.

A test fails by an AssertionError and is skipped by returning a text that says why.
"""
import sys
import traceback


def run(names, path):
    """names: globals() of the script. -> exit status."""
    tests = [(n, f) for n, f in names.items() if n.startswith("test_") and callable(f)]
    wanted = sys.argv[1:]
    tests = [t for t in tests if not wanted or t[0] in wanted]
    failed = ignored = 0
    for name, test in tests:
        try:
            why = test()
        except Exception as error:  # a broken script is a failed test, with its place
            failed += 1
            if not isinstance(error, AssertionError):
                traceback.print_exc(file=sys.stdout)
            place = traceback.extract_tb(error.__traceback__)[-1]
            print(f"{path}:{place.lineno}:{name}:FAIL: {error}", flush=True)
            continue
        ignored += bool(why)
        print(f"{path}:0:{name}:" + (f"IGNORE: {why}" if why else "PASS"), flush=True)
    print(f"\n{len(tests)} Tests {failed} Failures {ignored} Ignored")
    return 1 if failed else 0
