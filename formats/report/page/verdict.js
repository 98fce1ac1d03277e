'use strict';
// The verdict on top of every page.

/** What to do about a violation, by what it is about. The message itself says where and how much. */
gravure.remedy = (violation) => {
  const rules = [
    [/not compared|cannot be read|not found|no images/i, 'Give the folder with the images by --images, or put them back, and verify again.'],
    [/wrong pixel|differ/i, 'The images are not those that were compiled: compile the job again, or look for a damaged file.'],
    [/seam_um/i, 'gravure suggest lists nearby jobs that close exactly; fpga.fractional = true closes every job.'],
    [/landing_um/i, 'The error budget below shows which cause is largest; docs/error_budget.md says what lowers it.'],
    [/^(focus offset|incidence|displacement of the galvo) /i, 'Take a smaller --sigma-um: the stages then keep closer to the path.'],
    [/^landing /i, 'Take a smaller --pitch-um or a shorter servo period, or allow more by --landing-um.'],
    [/speed|acceleration|jerk/i, 'Compile it again within the limits of this machine: see gravure texture plan.'],
    [/compile/i, 'Compile the job again with this version.'],
  ];
  const found = rules.find(([pattern]) => pattern.test(violation));
  return found ? found[1] : null;
};

gravure.verdict = () => {
  const { verdict, job } = gravure.data;
  const { element, grouped } = gravure;
  const place = gravure.at('verdict');
  const good = verdict.within_limits;
  place.classList.toggle('bad', !good);
  place.append(element('div', { class: 'word' }, good ? '✓ Within limits' : '✗ Not within limits'));
  if (good) {
    place.append(element('p', { class: 'say' }, gravure.allGood()));
  } else {
    const list = element('ol');
    for (const violation of verdict.violations) {
      const item = element('li', {}, violation);
      const todo = gravure.remedy(violation);
      if (todo) item.append(element('span', { class: 'todo' }, todo));
      list.append(item);
    }
    place.append(element('p', { class: 'say' }, verdict.violations.length === 1 ? 'Do not cut before this is solved:' : `Do not cut before these ${verdict.violations.length} are solved:`), list);
  }
  const remarks = [...verdict.notes, ...job.warnings];
  if (remarks.length) {
    const list = element('ul');
    for (const remark of remarks) list.append(element('li', {}, remark));
    place.append(element('details', { open: remarks.length < 4 }, element('summary', {}, `${remarks.length} remark${remarks.length === 1 ? '' : 's'} that do${remarks.length === 1 ? 'es' : ''} not block`), list));
  }
};
