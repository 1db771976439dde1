"""What `lanewise replay` does with its files, and what it leaves."""
import json

import lanewise
import page
import replay_claim_alpha
import replay_claim_depth
import replay_claim_model
import replay_claim_noise
import replay_page
import replay_pictures
from kept import write as write_file
from replay_claims import Lab
from replay_render import Progress


def render_all(studio, topics):
    """{name of a shot: Rendered}, in the page's order."""
    shots = {}
    for shot in (shot for topic in topics for sheet in topic.sheets for shot in sheet.shots):
        shots.setdefault(shot.name, shot)  # another sheet's may be the same picture
    progress, rendered = Progress(len(shots)), {}
    for shot in shots.values():
        before = studio.rendered
        rendered[shot.name] = studio.shoot(shot)
        progress.step(shot.command, rendered[shot.name].seconds, studio.rendered > before)
    return rendered


def measure_claims(studio, place):
    """In the write-ups' order; without those that have no scene."""
    lab = Lab(studio, place)
    measures = (replay_claim_noise.fireflies, replay_claim_noise.importance, replay_claim_depth.depth_needed,
                replay_claim_depth.path_lengths, replay_claim_alpha.darker_and_sharper,
                replay_claim_model.departures)
    return [claim for measure in measures if (claim := measure(lab))]


def write(out, topics, rendered, claims, command, notes):
    for name, r in rendered.items():
        write_file(out / 'pictures' / f'{name}.png', page.encoded(page.to_srgb(r.picture)))
        if r.rate:
            write_file(out / 'pictures' / f'{name}-rate.png', r.rate)
    if rendered:
        write_file(out / 'contact-sheet.jpg', replay_pictures.contact_sheet(list(rendered.values())))
    figures = {'command': command, 'machine': lanewise.machine(), 'version': lanewise.version(), 'notes': notes,
               'pictures': [{'command': r.shot.command, 'shows': r.shot.shows, 'seconds': r.seconds, 'rays': r.rays,
                             'samples_per_pixel': r.samples_per_pixel, 'estimated_mrse': r.mrse}
                            for r in rendered.values()],
               'claims': [claim.figures() for claim in claims]}
    write_file(out / 'replay.json', json.dumps(figures, indent=1) + '\n')
    text = replay_page.page_of([(topic, rendered) for topic in topics], claims, command, figures['machine'],
                               figures['version'], notes)
    write_file(out / 'index.html', text)
