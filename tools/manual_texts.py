# SPDX-License-Identifier: Apache-2.0
"""What man pages say beyond --help: a description of each verb, and examples. tests/tools/manual_test.py compares the examples' options with the help."""

DESCRIPTIONS = {
    'slf': 'A surface light field is a set of points whose colour depends on the direction from which they are seen. slf makes one from '
           'photographs with known cameras, codes it into a small file, and draws any view of it again.\n\n'
           'Every verb has a page of its own: slf-encode(1) is where to begin.',
    'synth': 'Draws photographs of a scene of formulas, with their cameras and points: a capture to try the program with. The same words '
             'give the same bytes.',
    'encode': 'Reads a capture, which is photographs with cameras and points (cameras.json, COLMAP, Metashape and others), fits a function of '
              'direction to every point, and codes the functions. It also codes Gaussian splats, plenoptic clouds and directories of frames '
              'in time.',
    'plan': 'Finds what the parts of a large scene have in common, so that several machines can encode one part each. slf-encode(1) takes '
            'the plan, slf-merge(1) joins the parts.',
    'merge': 'Joins the parts of a scene, or of frames in time, to one file. Nothing is coded again.',
    'pack': 'Codes integers that are given as arrays of numpy: voxels and planes of values. Nothing is fitted, nothing is rounded unless '
            'steps are given.',
    'decode': 'Writes the points of a file with their mean colours, or every integer that was coded.',
    'render': 'Draws a file from an orbit, a camera or the view that the file names: one picture, several, a sheet, or a film.',
    'eval': 'Compares a file with the photographs that it was made from, and with those that were held out: PSNR of points and of pictures, '
            'SSIM, and where the error is.',
    'export': 'Writes a file that other programs draw. Colours are fitted by harmonics, so something is lost; the report says how much.',
    'info': 'Shows headers, sizes and settings of a file, and what a decode of it takes. No points are decoded.',
    'truncate': 'Leaves parts of a file out: what is left is decoded to the same integers as before.',
    'annotate': 'Writes notes or the scale of the world into a file. All else stays byte for byte but for the index, and is decoded to the same '
                'integers.',
    'html': 'Writes one page that holds the file, its decoder and a viewer. It is opened by a double click, without a server and without a '
            'network.',
    'igc': 'Codes the photographs by a video codec and the points by slf, to compare with. Readers of .slf do not read such files.',
    'settings': 'Lists what slf-encode(1) can be told: names, ranges and what holds where nothing is said.',
}

EXAMPLES = {
    'slf': [('slf synth can -o can', 'Draw a capture to try the program with'), ('slf encode can -o can.slf', 'Encode it'),
            ('slf render can.slf -o can.png', 'Draw a view'), ('slf html can.slf -o can.html', 'Make a page of it')],
    'synth': [('slf synth can -o can', 'A can of some hundred photographs'),
              ('slf synth walk --frames 8 -o walk', 'A figure that walks, eight captures'),
              ('slf synth --list', 'The names of all scenes')],
    'encode': [('slf encode can -o can.slf', 'As good as the photographs allow'),
               ('slf encode can -q 32 -o small.slf', 'Smaller, and coarser'),
               ('slf encode can --target-bytes 100000 -o can.slf', 'A file of so many bytes'),
               ('slf encode can --effort 1 -o can.slf', 'Quickly')],
    'plan': [('slf plan street --work store -o plan.json', 'Once, before the parts'),
             ('slf encode street --plan plan.json --part 1/4 --work store -o 1.slf', 'A part, on any machine')],
    'merge': [('slf merge 1.slf 2.slf 3.slf 4.slf -o street.slf', 'All parts of a scene')],
    'pack': [('slf pack positions.npy components.npy -o x.slf', 'Voxels and planes of values')],
    'decode': [('slf decode can.slf -o can.ply', 'A cloud with mean colours'), ('slf decode can.slf --dump can_arrays', 'Every integer')],
    'render': [('slf render can.slf --orbit 8 --sheet -o sheet.png', 'Eight views on one sheet'),
               ('slf render can.slf --orbit 90 -o turn.avi', 'A film'),
               ('slf render can.slf --camera can/cameras.json:0011 -o view.png', 'The view of a photograph')],
    'eval': [('slf eval can.slf can', 'Against its capture'), ('slf eval can.slf can --min-image-psnr 30', 'Exit status 8 below 30 dB')],
    'export': [('slf export can.slf -o can.spz', 'Splats, small'), ('slf export can.slf --mean -o can.ply', 'Points with one colour each')],
    'info': [('slf info can.slf', 'For people'), ('slf info can.slf --json', 'For programs')],
    'truncate': [('slf truncate can.slf --max-bytes 20000 -o small.slf', 'As much as fits'),
                 ('slf truncate can.slf --levels 7 -o coarse.slf', 'A coarser cloud')],
    'annotate': [('slf annotate can.slf notes.json -o noted.slf', 'Notes from the editor of the viewer'),
                 ('slf annotate can.slf none --metres-per-unit 0.001 -o bare.slf', 'Without notes, in millimetres')],
    'html': [('slf html can.slf -o can.html', 'A page'), ('slf html can.slf --autorotate 10 --title Can -o can.html', 'One that turns')],
    'igc': [('slf igc can -o can.igc --qp 30', 'At one quality'), ('slf eval can.igc can', 'What it is worth')],
    'settings': [('slf settings', 'For people'), ('slf settings --json', 'For programs')],
}
