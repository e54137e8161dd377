/// The columns of `drape table`, as pages show them.
import {formula} from './text.js';

const titles = {
  iterations: 'Newton iterations', shortened_steps: 'shortened steps', seconds: 'time [s]', cpu_seconds: 'CPU time [s]', preview_seconds: 'preview after [s]',
  energy_released: 'energy released [J]', smallest_gap: 'smallest gap [m]', force_residual: 'force residual', decrement: 'decrement [m/s]', peak_memory_bytes: 'peak memory [B]',
  stretch_warp: 'stretch along warp [%]', stretch_warp_95: 'along warp, 95 % of the area below [%]', largest_stretch_warp: 'largest along warp [%]',
  stretch_weft: 'stretch along weft [%]', stretch_weft_95: 'along weft, 95 % of the area below [%]', largest_stretch_weft: 'largest along weft [%]',
  ease: 'ease [mm]', pressure: 'pressure [kPa]', pressure_mmhg: 'pressure [mmHg]', pressure_95: 'pressure, 95 % of the area below [kPa]', largest_pressure: 'largest pressure [kPa]',
  lowest_eigenvalue: 'lowest eigenvalue of M⁻¹H [1/s²]', curvature_ratio: 'curvature ratio',
};
export const costs = {seconds: 'time [s]', iterations: 'Newton iterations', flops: 'flops of factorisations'};
export const targets = {reference: 'the reference', own: 'the method’s own end'};

/// All columns that the metrics of results.json declare, with their scope.
export const metricColumns = (metrics, scope) => Object.values(metrics || {}).filter(metric => metric.scope === scope).flatMap(metric => metric.columns);
const withUnit = ({name, label, unit}) => (label || name) + (unit && unit !== '1' ? ` [${unit}]` : '');

/// {title, text, ofReference} of a column by its name. `text` is the title without marks, for plots and lists; `ofReference`: it is a
/// distance from the reference.
export function describe(name, {measures = [], metrics = {}} = {}) {
  const metric = ['state', 'pair'].flatMap(scope => metricColumns(metrics, scope)).find(column => column.name === name);
  const measure = measures.find(m => name === 'preview_' + m.name || name === 'error_' + m.name || name === m.name && m.name === 'energy_gap');
  const text = titles[name] || (measure ? (name.startsWith('preview_') ? 'preview from its own end: ' : 'end from the reference: ') + measure.label : metric ? withUnit(metric) : name);
  return {text, ofReference: !!measure && !name.startsWith('preview_'), title: titles[name] || (!measure && !metric) ? text : formula(text)};
}

/// Columns for a table; `few` are those that are shown at first.
export const columnsOf = (names, few, of) => [...few.filter(name => names.includes(name)), ...names.filter(name => !few.includes(name))].map(name => ({name, ...describe(name, of), few: few.includes(name)}));

/// The measure by which pages compare: the first that ranks.
export const ranking = measures => (measures.find(measure => measure.use === 'ranking') || measures[0] || {name: 'energy_gap'}).name;
