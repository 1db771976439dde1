"""What the commands of `lanewise` that are scripts share: their command lines, and how they fail: in one line."""
import argparse
import importlib.util
import sys


class Problem(Exception):
    """One line for the user; code: the exit code."""

    def __init__(self, text, code=1):
        super().__init__(text)
        self.code = code


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Problem(message.removeprefix('argument ') + f'; see {self.prog} --help', 2)


def parser_of(name, document):
    """name: the command's. document: a line, then paragraphs for --help's end."""
    first, _, rest = document.partition('\n\n')
    return Parser(f'lanewise {name}', description=first.partition(':')[0] + '.', epilog=rest,
                  formatter_class=argparse.RawDescriptionHelpFormatter)


def positive(word):
    if not word.isdigit() or int(word) == 0:
        raise argparse.ArgumentTypeError(f"'{word}' is not a whole number above 0")
    return int(word)


def need(*modules):
    for module in modules:
        if not importlib.util.find_spec(module):
            package = 'pil' if module == 'PIL' else module
            sys.exit(f'lanewise: {module} is not installed: apt install python3-{package}')


def run(main):
    try:
        sys.exit(main())
    except Problem as problem:
        print(f'lanewise: {problem}', file=sys.stderr)
        sys.exit(problem.code)
    except KeyboardInterrupt:
        sys.exit('lanewise: stopped; the same command goes on where this ended')
