// The fields that one uses first, and the others by groups that can be opened.
import { Accordion } from '@mantine/core';
import type { Field } from '../../protocol/fields';
import type { Values } from '../../protocol/messages';
import { FieldList } from './field_list';
import type { Change } from './use_drag';

export type FieldGroup = { title: string; names: RegExp };

type Props = { fields: Field[]; first: string[]; groups: FieldGroup[]; values: Values; lengthUnit: string; onChange: Change };

export function GroupedFields({ fields, first, groups, ...rest }: Props) {
  const used = new Set(first);
  const parts = groups
    .map(({ title, names }) => {
      const own = fields.filter((field) => !used.has(field.name) && names.test(field.name));
      own.forEach((field) => used.add(field.name));
      return { title, own };
    })
    .filter(({ own }) => own.length > 0);
  const others = fields.filter((field) => !used.has(field.name));
  if (others.length > 0) parts.push({ title: 'More', own: others });
  const shown = first.map((name) => fields.find((field) => field.name === name)).filter((field) => field !== undefined);
  return (
    <>
      <FieldList fields={shown} {...rest} />
      <Accordion multiple variant="default" mt="xs" styles={{ control: { paddingInline: 0, minHeight: '2rem' }, label: { paddingBlock: '0.375rem', fontSize: '0.8125rem' }, content: { paddingInline: 0 }, item: { borderColor: 'var(--line)' } }}>
        {parts.map(({ title, own }) => (
          <Accordion.Item key={title} value={title}>
            <Accordion.Control>{title}</Accordion.Control>
            <Accordion.Panel>
              <FieldList fields={own} {...rest} />
            </Accordion.Panel>
          </Accordion.Item>
        ))}
      </Accordion>
    </>
  );
}
