// What is wrong with the connection, over the picture, which stays.
import { Alert, Loader } from '@mantine/core';
import { useStore } from '../state/store';

export function Banner() {
  const lost = useStore((s) => s.connection === 'lost');
  if (!lost) return null;
  return (
    <Alert className="banner" role="alert" color="orange.4" variant="filled" autoContrast icon={<Loader size="xs" color="dark" />} title="The connection to the program was lost" data-testid="lost">
      The page tries again by itself. If the program was ended, start it again and open the address that it prints.
    </Alert>
  );
}
