// All of the library, its bytes inlined.
import * as sightline from 'sightline-culling';
import { cullARow } from './row.mjs';

await sightline.ready;
cullARow(sightline);
