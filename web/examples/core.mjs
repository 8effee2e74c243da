// The small module.
import * as sightline from 'sightline-culling/core';
import { cullARow } from './row.mjs';

await sightline.ready;
cullARow(sightline);
