// The tables of fields, from docs/scene.schema.json, which the program writes: kind, range, default and line of manual of everything that a panel shows.
import schema from '../../../docs/scene.schema.json';

export type FieldKind = 'number' | 'integer' | 'boolean' | 'choice' | 'color' | 'vector' | 'text' | 'names';

export type Field = {
  name: string;
  kind: FieldKind;
  doc: string;
  unit: string;
  minimum?: number;
  maximum?: number;
  choices: string[];
  default: unknown;
};

type Property = {
  description?: string;
  type?: string;
  enum?: string[];
  const?: string;
  minimum?: number;
  maximum?: number;
  default?: unknown;
  pattern?: string;
  items?: Property;
  anyOf?: Property[];
};
type Properties = Record<string, Property>;

const definitions = schema.$defs as unknown as Record<string, { properties?: Properties; then?: { properties: Properties }; else?: { properties: Properties } }>;

function kindOf(property: Property): FieldKind | null {
  if (property.enum) return 'choice';
  if (property.type === 'boolean' || property.type === 'integer' || property.type === 'number') return property.type;
  if (property.type === 'string') return 'text';
  if (property.type === 'array' && property.items?.type === 'number') return 'vector';
  if (property.anyOf?.some((one) => one.pattern !== undefined)) return 'color';
  if (property.anyOf?.some((one) => one.items?.type === 'string')) return 'names';
  return null;
}

function fieldsOf(properties: Properties | undefined): Field[] {
  const fields: Field[] = [];
  for (const [name, property] of Object.entries(properties ?? {})) {
    const kind = kindOf(property);
    if (!kind || name === 'name' || name === 'library' || !('default' in property)) continue;
    const [, doc, unit] = /^(.*?)(?: \(([^()]*)\))?$/.exec(property.description ?? '') ?? ['', '', ''];
    const range = kind === 'color' ? (property.anyOf?.find((one) => one.type === 'number') ?? {}) : property;
    fields.push({ name, kind, doc, unit: unit ?? '', minimum: range.minimum, maximum: range.maximum, choices: property.enum ?? [], default: property.default });
  }
  return fields;
}

export const physicalFields = fieldsOf(definitions.material.else?.properties);
export const classicFields = fieldsOf(definitions.material.then?.properties);
export const lightFields = fieldsOf(definitions.light.properties);
export const environmentFields = fieldsOf(definitions.environment.properties);
export const settingsFields = fieldsOf(definitions.settings.properties);

export const fieldsOfMaterial = (material: Record<string, unknown>) => (material.model === 'classic' ? classicFields : physicalFields);

// The unit that a number is shown with: lengths are in the unit of the scene.
export function unitOf(field: Field, lengthUnit: string): string {
  if (field.unit === 'deg') return '°';
  return field.unit.replace('length', lengthUnit).replace('|', ' or ').replace('m^2', 'm²');
}

// `base_color` as people read it.
export function labelOf(name: string): string {
  if (name === 'ior') return 'Index of refraction';
  const words = name.replaceAll('_', ' ');
  return words.charAt(0).toUpperCase() + words.slice(1);
}
