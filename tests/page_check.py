#!/usr/bin/python3
"""Looks at a page in headless Chromium, in windows of several widths: nothing is wrong on the console, every chart is
there, nothing overlaps or sticks out sideways (page_check.js).

    tests/page_check.py index.html --charts 6                       # says what is wrong; exit code 1 if anything is
    tests/page_check.py index.html --charts 6 --screenshots look    # and look-1280.png, look-400.png
"""
import argparse
import base64
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

CHROMIUM = shutil.which('chromium')
CHECK = pathlib.Path(__file__).with_suffix('.js')


class Browser:
    """Chromium, spoken to over pipes in its DevTools protocol: a JSON object, then a zero byte."""

    def __init__(self, folder):
        commands, self.commands = os.pipe()
        self.answers, answers = os.pipe()
        flags = ['--headless', '--disable-gpu', '--hide-scrollbars', '--remote-debugging-pipe',
                 f'--user-data-dir={folder}']
        if os.geteuid() == 0:
            flags.append('--no-sandbox')  # which root cannot have
        # It reads from 3 and writes to 4.
        self.process = subprocess.Popen(
            ['/bin/bash', '-c', f'exec "$@" 3<&{commands} 4>&{answers}', 'bash', CHROMIUM, *flags],
            pass_fds=(commands, answers), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(commands)
        os.close(answers)
        self.stream, self.number, self.session, self.events = os.fdopen(self.answers, 'rb'), 0, None, []
        target = self.call('Target.createTarget', url='about:blank')['targetId']
        self.session = self.call('Target.attachToTarget', targetId=target, flatten=True)['sessionId']
        for domain in ('Page', 'Runtime', 'Log'):
            self.call(f'{domain}.enable')

    def call(self, method, **parameters):
        self.number += 1
        message = {'id': self.number, 'method': method, 'params': parameters}
        if self.session:
            message['sessionId'] = self.session
        os.write(self.commands, json.dumps(message).encode() + b'\0')
        while True:
            answer = self._read()
            if answer.get('id') != self.number:
                self.events.append(answer)
            elif 'error' in answer:
                raise RuntimeError(f'{method}: {answer["error"]["message"]}')
            else:
                return answer['result']

    def open(self, url, width):
        """What the console said."""
        self.events = []
        self.call('Emulation.setDeviceMetricsOverride', width=width, height=900, deviceScaleFactor=1, mobile=False)
        self.call('Page.navigate', url=url)
        while not any(event.get('method') == 'Page.loadEventFired' for event in self.events):
            self.events.append(self._read())
        return [said for event in self.events if (said := _complaint(event))]

    def evaluate(self, expression):
        return self.call('Runtime.evaluate', expression=expression, returnByValue=True)['result'].get('value')

    def close(self):
        os.close(self.commands)  # which ends it
        self.process.wait()

    def _read(self):
        text = bytearray()
        while (byte := self.stream.read(1)) != b'\0':
            if not byte:
                raise RuntimeError(f'{CHROMIUM} ended')
            text += byte
        return json.loads(text)


def _complaint(event):
    """Of an event, or None: errors and warnings, by the page's scripts or about what it asks for."""
    what = event.get('params', {})
    if event.get('method') == 'Runtime.exceptionThrown':
        return what['exceptionDetails'].get('exception', {}).get('description', what['exceptionDetails']['text'])
    if event.get('method') == 'Runtime.consoleAPICalled' and what['type'] in ('error', 'warning', 'assert'):
        return ' '.join(str(a.get('value', a.get('description'))) for a in what['args'])
    if event.get('method') == 'Log.entryAdded' and what['entry']['level'] in ('error', 'warning'):
        return what['entry']['text'] + ' ' + what['entry'].get('url', '')
    return None


def main():
    parser = argparse.ArgumentParser(description='Looks at a page in headless Chromium.')
    parser.add_argument('page', type=pathlib.Path)
    parser.add_argument('--charts', type=int, required=True, help='how many there must be')
    parser.add_argument('--widths', type=int, nargs='+', default=[1280, 400], help='of the window, in pixels')
    parser.add_argument('--screenshots', metavar='NAME', help='write NAME-WIDTH.png')
    args = parser.parse_args()
    if not CHROMIUM:
        sys.exit('page_check.py: chromium is not installed; tools/setup charts installs it')
    if not args.page.is_file():
        sys.exit(f'page_check.py: {args.page}: no such file')
    complaints = []
    with tempfile.TemporaryDirectory() as folder:
        browser = Browser(folder)
        for width in args.widths:
            found = [f'console: {said}' for said in browser.open(args.page.resolve().as_uri(), width)]
            found += browser.evaluate(f'({CHECK.read_text()})({args.charts})')
            complaints += [f'{width} pixels: {complaint}' for complaint in found]
            if args.screenshots:
                picture = browser.call('Page.captureScreenshot', captureBeyondViewport=True)['data']
                pathlib.Path(f'{args.screenshots}-{width}.png').write_bytes(base64.b64decode(picture))
        browser.close()
    print('\n'.join(complaints) or f'{args.page}: nothing is wrong at {args.widths} pixels')
    return 1 if complaints else 0


if __name__ == '__main__':
    sys.exit(main())
