// What a benchmark measured: to the terminal, and with --csv FILE as rows of benchmarks/results (its README says what each column
// is), for scripts/measure.sh.
import { writeFileSync } from 'node:fs';

const median = (all) => all.toSorted((a, b) => a - b)[Math.floor(all.length / 2)];

/** `times` are milliseconds by name; `beside` names, for some, the rows that they are compared with, each of which then tells how
 * many times as long it takes. */
export function writeRows(benchmark, times, beside, answers = {}) {
  const lines = ['benchmark,case,unit,median,min,max,repetitions,beside,ratio,kept,lost,lost_pixels,excess,commit,date'];
  const ratioOf = {};
  for (const [name, others] of Object.entries(beside)) {
    for (const other of others) if (times[other]) ratioOf[other] = [name, median(times[other]) / median(times[name])];
  }
  for (const [name, all] of Object.entries(times)) {
    const [to, ratio] = ratioOf[name] ?? [];
    const middle = median(all);
    console.log(`${name.padEnd(36)} ${middle.toFixed(3).padStart(10)} ms (${Math.min(...all).toFixed(3)} to ${Math.max(...all).toFixed(3)})` +
      `${answers[name] === undefined ? '' : `, answer ${answers[name]}`}${to ? `; ${ratio.toFixed(3)} times ${to}` : ''}`);
    lines.push([benchmark, name, 'ms', middle, Math.min(...all), Math.max(...all), all.length, to ? `${benchmark}/${to}` : '', ratio ?? '',
      answers[name] ?? '', '', '', '', '', ''].join());
  }
  const at = process.argv.indexOf('--csv');
  if (at > 0) writeFileSync(process.argv[at + 1], `${lines.join('\n')}\n`);
}
